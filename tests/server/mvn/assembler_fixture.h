/// A stream that a test sends, drops, swaps or repeats as it likes.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/system/clocks.h"
#include "server/mvn/assembler.h"
#include "server/mvn/encode.h"
#include "tests/server/mvn/mvn_testing.h"

namespace kinescope::mvn::testing {

inline constexpr std::int64_t kPeriod = kNanosPerSecond / 240;

inline Endpoint Sender(std::uint8_t host, std::uint16_t port = 1) {
  Endpoint endpoint;
  endpoint.address[15] = host;
  endpoint.port = port;
  return endpoint;
}

// One stream at 240 Hz whose datagrams the test sends, drops, swaps or repeats. Time only moves
// when the test says so.
class AssemblerTest : public ::testing::Test {
 protected:
  Arrival now() const { return {now_, now_ + 1'700'000'000'000'000'000}; }
  void Wait(std::int64_t nanos) { now_ += nanos; }

  void Send(const std::string& datagram) { assembler_.Add(sender_, datagram, now(), sink_); }
  void Send(const std::vector<std::string>& datagrams) {
    for (const std::string& datagram : datagrams) Send(datagram);
  }

  // Types 02, 20, 21, 22, 24 of one sample.
  std::vector<std::string> Datagrams(std::uint32_t counter, int character = 0) {
    BodySample sample = RandomSample(random_, counter);
    sample.character = character;
    return EncodeSample(sample);
  }

  // Whole samples until the stream's types are learnt; what they gave is forgotten.
  void LearnFrom(std::uint32_t first_counter, int samples = 6) {
    for (int i = 0; i < samples; ++i) {
      Send(Datagrams(first_counter + static_cast<std::uint32_t>(i)));
      Wait(kPeriod);
    }
    sink_.samples.clear();
  }

  std::vector<std::uint32_t> GivenCounters() const {
    std::vector<std::uint32_t> counters;
    for (const BodySample& sample : sink_.samples) counters.push_back(sample.counter);
    return counters;
  }

  SourceCounters counters() const { return assembler_.counters(); }

  // Every datagram ended in exactly one place, once the last sample is closed.
  void ExpectAllAccountedFor() {
    Wait(4000 * kNanosPerMilli);
    assembler_.Expire(now_, sink_);
    EXPECT_EQ(assembler_.tally().settled(), assembler_.tally().datagrams);
    EXPECT_EQ(assembler_.deadline_nanos(), std::nullopt);
  }

  RandomValues random_{4};
  Assembler assembler_{{Stamps::kFitted, Delivery::kPrompt}};
  RecordingSink sink_;
  Endpoint sender_ = Sender(1);
  std::int64_t now_ = 5'000'000'000;
};

}  // namespace kinescope::mvn::testing
