/// Remembers the datagrams of recently delivered samples, to distinguish a repeated datagram, a
/// late one, and a sender that starts over. One thread, no allocation.
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
    kNo,        // no sample with this counter and time code
    kSame,      // the same datagram
    kMissing,   // the sample is known and lacked this message
    kDifferent  // the sample is known with another message of this type
  };

  Known Find(const Header& header, SampleType type, std::uint32_t digest) const {
    const Entry& entry = entries_[IndexOf(header.sample_counter)];
    if (!entry.is_used || entry.counter != header.sample_counter) return Known::kNo;
    if (entry.time_code_millis != header.time_code_millis) return Known::kDifferent;
    const auto index = static_cast<std::size_t>(type);
    if (!entry.types.test(index)) return Known::kMissing;
    // Of a message in parts only the first part is remembered.
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
