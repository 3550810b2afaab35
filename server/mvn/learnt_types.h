/// Learns which message types a stream sends with every sample, and follows when a type is switched
/// on or off. One thread.
#pragma once

#include <algorithm>
#include <array>

#include "server/mvn/pending_sample.h"

namespace kinescope::mvn {

class LearntTypes {
 public:
  /// Adds the types of one more sample.
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

  /// Marks `type` as part of every sample from now on.
  void Expect(SampleType type) {
    usual_.set(static_cast<std::size_t>(type));
    missed_[static_cast<std::size_t>(type)] = 0;
  }

  bool are_known() const { return samples_ >= kSamplesToLearn; }

  /// Whether `types` contains all expected types; false until these are known.
  bool AreAllIn(SampleTypes types) const { return are_known() && (usual_ & ~types).none(); }

  bool IsAnyMissingIn(SampleTypes types) const { return (usual_ & ~types).any(); }

 private:
  static constexpr int kSamplesToLearn = 3;
  static constexpr int kMissesToForget = 5;

  SampleTypes usual_;
  std::array<int, kSampleTypeCount> missed_{};  // consecutive samples without it
  int samples_ = 0;
};

}  // namespace kinescope::mvn
