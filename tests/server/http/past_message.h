/// The answer to a request for former states, taken apart as docs/http.md has it.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "server/http/protocol.h"

namespace kinescope::http::testing {

struct PastMessage {
  struct State {
    std::uint64_t number = 0;
    double made_micros = 0;
    std::string details;  // "": those of the state before
  };

  explicit PastMessage(const Bytes& bytes) {
    EXPECT_GE(bytes.size(), kPastHeaderBytes);
    if (bytes.size() < kPastHeaderBytes) return;
    EXPECT_EQ(bytes[0], static_cast<std::uint8_t>(MessageKind::kPast));
    const auto count = At<std::uint16_t>(bytes, 2);
    id = At<std::uint32_t>(bytes, 4);
    until_micros = At<double>(bytes, 8);
    std::size_t at = kPastHeaderBytes;
    for (std::size_t i = 0; i < count; ++i) {
      const auto size = At<std::uint32_t>(bytes, at), text = At<std::uint32_t>(bytes, at + 4);
      at += kPastStateBytes;
      State state;
      state.number = static_cast<std::uint64_t>(At<double>(bytes, at + 8));
      state.made_micros = At<double>(bytes, at + 72);
      at += size;
      for (std::size_t end = at + text; at < end; ++at) {
        state.details += static_cast<char>(bytes.at(at));
      }
      states.push_back(state);
    }
    EXPECT_EQ(at, bytes.size());
  }
  std::vector<std::uint64_t> Numbers() const {
    std::vector<std::uint64_t> numbers;
    for (const State& state : states) numbers.push_back(state.number);
    return numbers;
  }

  std::uint32_t id = 0;
  double until_micros = 0;
  std::vector<State> states;

 private:
  template <class Value>
  static Value At(const Bytes& bytes, std::size_t at) {
    Value value{};
    EXPECT_LE(at + sizeof value, bytes.size());
    if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  }
};

}  // namespace kinescope::http::testing
