/// What came for the latest samples that were already given on, so that what comes after can be
/// told apart: the same datagram once more, a late one, or a sender that counts from the start
/// again. One thread, allocates nothing.
#pragma once

#include <array>
#include <cstdint>

#include "server/mvn/pending_sample.h"

namespace kinescope::mvn {

class ClosedSamples {
 public:
  void Add(const PendingSample& sample) {
    entries_[IndexOf(sample.counter())] = {true, sample.counter(), sample.time_code_millis(),
                                           sample.begun(), sample.digests()};
  }

  enum class Known {
    kNo,        // no sample of this counter and time code
    kSame,      // this very datagram
    kMissing,   // the sample is known, and this message was missing in it
    kDifferent  // the sample is known with another message in this one's place
  };

  Known Find(const Header& header, SampleType type, std::uint32_t digest) const {
    const Entry& entry = entries_[IndexOf(header.sample_counter)];
    if (!entry.is_used || entry.counter != header.sample_counter) return Known::kNo;
    if (entry.time_code_millis != header.time_code_millis) return Known::kDifferent;
    const auto index = static_cast<std::size_t>(type);
    if (!entry.types.test(index)) return Known::kMissing;
    // Of a message in parts only the first is remembered.
    return header.part > 0 || entry.digests[index] == digest ? Known::kSame : Known::kDifferent;
  }

  void Clear() { entries_.fill(Entry()); }

 private:
  static constexpr std::size_t kSize = 128;  // half a second at 240 Hz

  struct Entry {
    bool is_used = false;
    std::uint32_t counter = 0;
    std::uint32_t time_code_millis = 0;
    SampleTypes types;
    SampleDigests digests{};
  };

  static std::size_t IndexOf(std::uint32_t counter) { return counter % kSize; }

  std::array<Entry, kSize> entries_{};
};

}  // namespace kinescope::mvn
