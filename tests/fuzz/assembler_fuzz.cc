// A whole session with a hostile network. The input is a row of records: sender (1 byte),
// milliseconds since the one before (1 byte), length (2 bytes, big-endian), datagram.
#include <cstddef>
#include <cstdint>
#include <map>
#include <string_view>

#include "core/system/clocks.h"
#include "server/mvn/assembler.h"
#include "server/mvn/byte_order.h"
#include "tests/fuzz/invariants.h"

namespace assembler_fuzz {
namespace {

using namespace kinescope;

constexpr std::int64_t kEpoch = 1'700'000'000'000'000'000;
constexpr std::size_t kMaxRecords = 5000;

struct CheckingSink : SampleSink {
  void OnCharacter(const Character& character) override {
    KINESCOPE_CHECK(character.name.size() <= 128);
    if (character.skeleton) KINESCOPE_CHECK(std::isfinite(character.skeleton->height));
    known[character.id] = true;
  }
  void OnSample(const BodySample& sample) override {
    fuzz::CheckSample(sample);
    KINESCOPE_CHECK(known[sample.character]);
    KINESCOPE_CHECK(sample.stamp_nanos > 0);
    ++samples;
  }
  void OnObjects(const ObjectsSample& sample) override {
    KINESCOPE_CHECK(known[sample.character] && sample.present.any() && sample.stamp_nanos > 0);
    for (const urdf::Pose& pose : sample.poses) KINESCOPE_CHECK(pose.position.allFinite());
    ++samples;
  }
  std::map<int, bool> known;
  std::uint64_t samples = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mvn::ByteReader in({reinterpret_cast<const char*>(data), size});
  mvn::Assembler assembler({mvn::Stamps::kFitted, mvn::Delivery::kPrompt});
  CheckingSink sink;
  std::int64_t now = 1'000'000'000;
  std::uint8_t sender = 0, wait = 0;
  std::uint16_t length = 0;
  std::string_view datagram;
  for (std::size_t i = 0; i < kMaxRecords && in.Read(sender) && in.Read(wait) && in.Read(length) &&
                          in.ReadBytes(length, datagram);
       ++i) {
    now += wait * kNanosPerMilli;
    const auto deadline = assembler.deadline_nanos();
    if (deadline && *deadline <= now) {
      assembler.Expire(now, sink);
      KINESCOPE_CHECK(!assembler.deadline_nanos() || *assembler.deadline_nanos() > now);
    }
    mvn::Endpoint endpoint;
    endpoint.address[0] = sender & 0x0FU;
    endpoint.port = static_cast<std::uint16_t>(sender >> 4U);
    assembler.Add(endpoint, datagram, {now, kEpoch + now}, sink);
  }
  assembler.Expire(now + 10'000 * kNanosPerMilli, sink);
  KINESCOPE_CHECK(!assembler.deadline_nanos());
  KINESCOPE_CHECK(assembler.tally().settled() == assembler.tally().datagrams);
  KINESCOPE_CHECK(assembler.counters().samples == sink.samples);
  return 0;
}

}  // namespace assembler_fuzz
