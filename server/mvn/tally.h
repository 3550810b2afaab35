/// Counts the result of every datagram. Arrays are used while running, so that counting allocates
/// nothing; ToCounters() converts them. One thread.
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
  std::uint64_t lost = 0;
  std::uint64_t restarts = 0;
  std::uint64_t outliers = 0;
  std::uint64_t mismatched_ids = 0;        // items whose place contradicts their id; not datagrams
  std::array<std::uint64_t, 100> types{};  // datagrams read, by message type
  std::array<std::uint64_t, kReasonCount> rejected{};
  DurationHistogram delays;         // as in SourceCounters
  std::uint64_t in_samples = 0;     // datagrams of delivered samples
  std::uint64_t in_characters = 0;  // types 12 and 13 that were used

  void Reject(Reason reason, std::uint64_t count = 1) {
    rejected[static_cast<std::size_t>(reason)] += count;
  }
  void CountType(Type type) { ++types[static_cast<std::size_t>(type)]; }

  /// Datagrams with a final result; the other `datagrams` belong to samples that still wait.
  std::uint64_t settled() const {
    std::uint64_t sum = in_samples + in_characters + duplicates + late + outliers;
    for (const std::uint64_t count : rejected) sum += count;
    return sum;
  }

  SourceCounters ToCounters() const;
};

}  // namespace kinescope::mvn
