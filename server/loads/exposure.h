/// Exposure to joint loads: how the momentary ratios of a trial are distributed, and how often and
/// for how long they are above the class limits. Nothing here depends on what is shown
/// (load_meter.h). Limits for a working day are about distributions, a class describes an instant
/// (joint-loads.md 4.5). One thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "core/scene_state.h"
#include "server/loads/load_meter.h"
#include "server/loads/sample_times.h"

namespace kinescope::loads {

/// Time in each band so far, without the newest sample. Memory does not grow with time.
class BandTimes {
 public:
  /// Adds the next state of a person's loads, in the order of kScoredJoints.
  void Add(const std::array<JointLoad, urdf::kScoredJointCount>& loads, std::int64_t stamp_nanos);
  /// s, by LoadClass; `scored_joint`: index into kScoredJoints.
  std::array<double, kLoadClassCount> SecsOf(std::size_t scored_joint) const;

 private:
  SampleTimes times_;
  std::array<LoadClass, urdf::kScoredJointCount> last_{};
  std::array<std::array<std::int64_t, kLoadClassCount>, urdf::kScoredJointCount> nanos_{};
};

/// The smallest of `values` that at least `percent` % of them do not exceed; NaN: there are none.
/// Sorts a part of `values`.
template <class T>
T NearestRank(std::vector<T>& values, std::size_t percent) {
  if (values.empty()) return std::numeric_limits<T>::quiet_NaN();
  const std::size_t rank = (percent * values.size() + 99) / 100;
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

/// Of one joint and one class limit.
struct AboveLimit {
  double longest_secs = 0;  // longest uninterrupted time above it; unknown loads and gaps end it
  std::uint64_t rises = 0;  // from below it to above; a rise ends below the limit by the hysteresis
  double rises_per_min = 0;  // of the time in which the load is known; NaN: never
};

/// Exposure of one joint.
struct JointExposure {
  std::array<std::uint64_t, kLoadClassCount> samples{};  // by band
  std::array<double, kLoadClassCount> secs{};            // by band
  double p10 = 0, p50 = 0, p90 = 0;  // percentiles of the ratio over the samples in which it is
                                     // known, nearest rank; NaN: never known
  std::array<AboveLimit, 2> above;   // by class limit
  double peak_ratio = 0;             // NaN: never known
  double peak_moment = 0, peak_capacity = 0;  // N·m, in the governing direction at the peak
  std::string_view peak_channel;
  std::int64_t peak_stamp_nanos = 0;
};

/// Keeps all ratios: 8 bytes per joint and sample, 26 MB for an hour at 60 Hz.
class Exposure {
 public:
  explicit Exposure(const LoadMeter::Settings& limits = {}) : limits_(limits) {}

  /// Adds the next state of a person's loads, in the order of kScoredJoints. Returns for how long
  /// the one before it counts, s.
  double Add(const std::vector<JointLoad>& loads, std::int64_t stamp_nanos);
  /// To be called once, after the last sample. Returns for how long it counts, s.
  double Finish();

  /// @pre Finish() was called; scored_joint is an index into kScoredJoints
  JointExposure Of(std::size_t scored_joint) const;
  bool IsEverKnown(std::size_t scored_joint) const;
  std::uint64_t samples() const { return samples_; }
  double secs() const;  // time counted so far, s

 private:
  enum class Side { kUnknown, kBelow, kAbove };
  struct Limit {
    Side side = Side::kUnknown;
    std::int64_t hold_nanos = 0, longest_nanos = 0;
    std::uint64_t rises = 0;
  };
  struct Joint {
    std::vector<double> ratios;
    std::array<std::uint64_t, kLoadClassCount> samples{};
    std::array<std::int64_t, kLoadClassCount> nanos{};
    std::array<Limit, 2> limits;
    LoadClass last_band = LoadClass::kUnknown;
    JointLoad peak;
    std::int64_t peak_stamp_nanos = 0;
    bool has_peak = false;
  };
  double CountLast(std::int64_t nanos);
  void Cross(const JointLoad& load, Joint& joint) const;

  LoadMeter::Settings limits_;
  SampleTimes times_;
  std::array<Joint, urdf::kScoredJointCount> joints_{};
  std::uint64_t samples_ = 0;
  std::int64_t counted_nanos_ = 0;
};

}  // namespace kinescope::loads
