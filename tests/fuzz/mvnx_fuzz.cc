// Any bytes as an MVNX file: a SourceError with name and line, or samples that can be drawn.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

#include "core/system/errors.h"
#include "server/mvn/file/mvnx_source.h"
#include "tests/fuzz/invariants.h"

namespace mvnx_fuzz {
namespace {

struct CheckingSink : kinescope::SampleSink {
  void OnCharacter(const kinescope::Character&) override {}
  void OnSample(const kinescope::BodySample& sample) override {
    kinescope::fuzz::CheckSample(sample);
    KINESCOPE_CHECK(sample.stamp_nanos > last_stamp);
    last_stamp = sample.stamp_nanos;
  }
  std::int64_t last_stamp = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;  // fmemopen takes no empty buffer
  std::FILE* const file = fmemopen(const_cast<std::uint8_t*>(data), size, "rb");
  if (file == nullptr) return 0;
  try {
    kinescope::mvn::MvnxSource source(file, "fuzz.mvnx");
    CheckingSink sink;
    while (source.Poll(std::chrono::milliseconds(0), sink) == kinescope::Source::State::kMore) {
    }
  } catch (const kinescope::SourceError& error) {
    KINESCOPE_CHECK(std::string(error.what()).rfind("fuzz.mvnx:", 0) == 0);
  }
  return 0;
}

}  // namespace mvnx_fuzz
