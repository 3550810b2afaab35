/// Which message types a stream sends with every sample: learnt, and relearnt when a type is
/// switched on or off. One thread.
#pragma once

#include <algorithm>
#include <array>

#include "server/mvn/pending_sample.h"

namespace kinescope::mvn {

class LearntTypes {
 public:
  /// Takes the types of one sample more.
  void Learn(SampleTypes came) {
    samples_ = std::min(samples_ + 1, kSamplesToLearn);
    for (std::size_t type = 0; type < kSampleTypeCount; ++type) {
      if (came.test(type)) {
        Expect(static_cast<SampleType>(type));
      } else if (usual_.test(type) && ++missed_[type] >= kMissesToForget) {
        usual_.reset(type);
      }
    }
  }

  /// `type` belongs to every sample from now on.
  void Expect(SampleType type) {
    usual_.set(static_cast<std::size_t>(type));
    missed_[static_cast<std::size_t>(type)] = 0;
  }

  bool are_known() const { return samples_ >= kSamplesToLearn; }

  /// Whether all that can be expected is among `types`; false as long as that is not known.
  bool AreAllIn(SampleTypes types) const { return are_known() && (usual_ & ~types).none(); }

  bool IsAnyMissingIn(SampleTypes types) const { return (usual_ & ~types).any(); }

 private:
  static constexpr int kSamplesToLearn = 3;
  static constexpr int kMissesToForget = 5;

  SampleTypes usual_;
  std::array<int, kSampleTypeCount> missed_{};  // samples in a row without it
  int samples_ = 0;
};

}  // namespace kinescope::mvn
