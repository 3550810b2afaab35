/// Estimates the segment lengths of a person from poses if the source does not send them: once at
/// the start, and again when another person wears the suit. Pure; one thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/body_sample.h"
#include "core/system/clocks.h"

namespace kinescope {

class SkeletonWatch {
 public:
  /// Change of a segment length that counts. Measured people differ from their own skeleton by 5
  /// mm, at L5 by 15 mm (MVN places it between pelvis and T8).
  static constexpr double kOtherLength = 0.02;  // m
  /// Time for which the lengths must differ from the skeleton and agree with each other. Changes
  /// caused by a calibration or a lost sensor are shorter or not constant.
  static constexpr std::int64_t kForGoodNanos = kNanosPerSecond;

  /// Returns the person's skeleton when it is new: with the first sample that looks like a human,
  /// and when other lengths have lasted for kForGoodNanos. End points, which poses do not contain,
  /// follow from the stature (urdf/skeleton.h). @pre stamps never go back.
  std::optional<urdf::Skeleton> Look(const BodySample& sample);

 private:
  using Lengths = std::array<double, urdf::kSegmentCount>;  // from the parent to each segment, m;
                                                            // pelvis: 0

  static Lengths Measure(const BodySample& sample);
  static bool Agree(const Lengths& a, const Lengths& b);

  std::optional<Lengths> known_;      // of the skeleton in use
  std::optional<Lengths> candidate_;  // other lengths, seen since since_
  std::int64_t since_ = 0;
};

}  // namespace kinescope
