/// One person's lengths, measured from poses where nobody tells them: once at the beginning, and
/// again when somebody else has put on the suit. Pure; one thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/body_sample.h"

namespace kinescope {

class SkeletonWatch {
 public:
  /// A bone is another one when it is this much longer or shorter. Measured people differ from
  /// their own skeleton by 5 mm, at L5 by 15 (MVN places it between pelvis and T8).
  static constexpr double kOtherLength = 0.02;  // m
  /// So long the lengths must differ from the skeleton, and agree with each other: what a
  /// calibration or a lost sensor does to a body does not last, or does not stand still.
  static constexpr std::int64_t kForGoodNanos = 1'000'000'000;

  /// The person's skeleton when it is new: with the first sample that looks like a human, and with
  /// the sample that has had other lengths for kForGoodNanos. End points, which poses do not have,
  /// are those of the stature (urdf/skeleton.h). @pre stamps do not go back.
  std::optional<urdf::Skeleton> Look(const BodySample& sample);

 private:
  using Lengths = std::array<double, urdf::kSegmentCount>;  // of the bone to each; pelvis: 0

  static Lengths Measure(const BodySample& sample);
  static bool Agree(const Lengths& a, const Lengths& b);

  std::optional<Lengths> known_;      // of the skeleton in use
  std::optional<Lengths> candidate_;  // other lengths, seen since:
  std::int64_t since_ = 0;
};

}  // namespace kinescope
