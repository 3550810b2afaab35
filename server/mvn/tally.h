/// Counts what became of every datagram. Arrays while running, so that counting allocates nothing;
/// turned into SourceCounters when somebody asks.
#pragma once

#include <array>
#include <cstdint>

#include "core/source.h"
#include "server/mvn/datagram.h"

namespace kinescope::mvn {

struct Tally {
  std::uint64_t datagrams = 0;
  std::uint64_t bytes = 0;
  std::uint64_t samples = 0;
  std::uint64_t incomplete = 0;
  std::uint64_t duplicates = 0;
  std::uint64_t late = 0;
  std::uint64_t counter_gaps = 0;
  std::uint64_t restarts = 0;
  std::uint64_t outliers = 0;
  std::uint64_t odd_ids = 0;  // items told by their place against their id; no datagrams
  std::array<std::uint64_t, 100> types{};  // datagrams that were read, by message type
  std::array<std::uint64_t, kReasonCount> rejected{};
  std::uint64_t in_samples = 0;     // datagrams of samples given on
  std::uint64_t in_characters = 0;  // types 12 and 13 that were used

  void Reject(Reason reason, std::uint64_t count = 1) {
    rejected[static_cast<std::size_t>(reason)] += count;
  }
  void CountType(Type type) { ++types[static_cast<std::size_t>(type)]; }

  /// Datagrams that have ended somewhere; the rest of `datagrams` waits for the rest of its sample.
  std::uint64_t settled() const {
    std::uint64_t sum = in_samples + in_characters + duplicates + late + outliers;
    for (const std::uint64_t count : rejected) sum += count;
    return sum;
  }

  SourceCounters ToCounters() const;
};

}  // namespace kinescope::mvn
