// Any bytes as a capture or raw datagrams, read to the end: a SourceError with the file's name, or
// datagrams in order of time, and samples that can be drawn.
#include <spdlog/spdlog.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

#include "core/system/errors.h"
#include "core/system/input_file.h"
#include "server/mvn/assembler.h"
#include "server/mvn/file/pcap_datagrams.h"
#include "server/mvn/file/raw_file_datagrams.h"
#include "tests/fuzz/invariants.h"

namespace pcap_fuzz {
namespace {

using namespace kinescope;

struct CheckingSink : mvn::DatagramSink, SampleSink {
  void OnDatagram(const mvn::ReceivedDatagram& datagram) override {
    KINESCOPE_CHECK(datagram.bytes.size() <= mvn::kHeaderBytes + 65536);
    KINESCOPE_CHECK(datagram.arrival.monotonic_nanos >= newest);
    KINESCOPE_CHECK(datagram.arrival.monotonic_nanos == datagram.arrival.wall_nanos);
    newest = datagram.arrival.monotonic_nanos;
    assembler.Add(datagram.from, datagram.bytes, datagram.arrival, *this);
  }
  void OnCharacter(const Character&) override {}
  void OnSample(const BodySample& sample) override { fuzz::CheckSample(sample); }

  mvn::Assembler assembler{{mvn::Stamps::kFitted, mvn::Delivery::kPrompt}};
  std::int64_t newest = 0;
};

void ReadToEnd(mvn::DatagramSource& source) {
  CheckingSink sink;
  while (source.Poll({}, sink) != mvn::DatagramSource::State::kEnded) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const bool is_silent = (spdlog::set_level(spdlog::level::off), true);  // it warns a lot
  KINESCOPE_CHECK(is_silent);
  if (size == 0) return 0;  // fmemopen takes no empty buffer
  const auto open = [&] {
    return InputFile(fmemopen(const_cast<std::uint8_t*>(data), size, "rb"));
  };
  mvn::RawFileDatagrams raw(open(), "fuzz.bin");
  ReadToEnd(raw);
  try {
    mvn::PcapDatagrams capture(open(), "fuzz.pcap");
    ReadToEnd(capture);
  } catch (const SourceError& error) {
    KINESCOPE_CHECK(std::string(error.what()).rfind("fuzz.pcap: ", 0) == 0);
  }
  return 0;
}

}  // namespace pcap_fuzz
