#include "server/loads/exposure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/system/check.h"
#include "core/system/clocks.h"
#include "server/loads/gap.h"

namespace kinescope::loads {
namespace {

constexpr double kNoRatio = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t kLongestStepNanos = static_cast<std::int64_t>(kLongestGapSecs * 1e9);

}  // namespace

void Exposure::Add(const JointLoad* loads, std::int64_t stamp_nanos) {
  const std::int64_t step = stamp_nanos - last_nanos_;
  const bool counts = has_last_ && step >= 0;
  const std::int64_t nanos = counts ? std::min(step, kLongestStepNanos) : 0;
  counted_nanos_ += nanos;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    Joint& joint = joints_[i];
    const JointLoad& load = loads[i];
    joint.class_nanos[static_cast<std::size_t>(joint.last_class)] += nanos;
    if (std::isfinite(joint.last_ratio)) {
      const double bin = std::clamp(joint.last_ratio / kExposureBin, 0.0, kBins - 1.0);
      joint.nanos[static_cast<std::size_t>(bin)] += nanos;
    }
    joint.last_class = load.load_class;
    joint.last_ratio = load.load_class == LoadClass::kUnknown ? kNoRatio : load.ratio;
    if (std::isfinite(joint.last_ratio) && (!joint.has_peak || load.ratio > joint.peak.ratio)) {
      joint.peak = load;
      joint.peak_stamp_nanos = stamp_nanos;
      joint.has_peak = true;
    }
  }
  has_last_ = true;
  last_nanos_ = stamp_nanos;
}

void Exposure::Add(const std::array<JointLoad, urdf::kScoredJointCount>& loads,
                   std::int64_t stamp_nanos) {
  Add(loads.data(), stamp_nanos);
}

void Exposure::Add(const std::vector<JointLoad>& loads, std::int64_t stamp_nanos) {
  KINESCOPE_CHECK(loads.size() == joints_.size());
  Add(loads.data(), stamp_nanos);
}

double Exposure::PercentileOf(const Joint& joint, double share) {
  std::int64_t all = 0;
  for (const std::int64_t nanos : joint.nanos) all += nanos;
  if (all == 0) return kNoRatio;
  std::int64_t below = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    below += joint.nanos[bin];
    if (static_cast<double>(below) < share * static_cast<double>(all)) continue;
    if (bin + 1 == kBins) return kExposureMost;
    return (static_cast<double>(bin) + 0.5) * kExposureBin;
  }
  return kExposureMost;
}

std::array<double, 4> Exposure::SecsOf(std::size_t scored_joint) const {
  KINESCOPE_CHECK(scored_joint < joints_.size());
  std::array<double, 4> secs;
  for (std::size_t i = 0; i < secs.size(); ++i) {
    secs[i] = Secs(joints_[scored_joint].class_nanos[i]);
  }
  return secs;
}

JointExposure Exposure::Of(std::size_t scored_joint) const {
  KINESCOPE_CHECK(scored_joint < joints_.size());
  const Joint& joint = joints_[scored_joint];
  JointExposure exposure;
  exposure.secs = SecsOf(scored_joint);
  exposure.p10 = PercentileOf(joint, 0.1);
  exposure.p50 = PercentileOf(joint, 0.5);
  exposure.p90 = PercentileOf(joint, 0.9);
  exposure.peak_ratio = joint.has_peak ? joint.peak.ratio : kNoRatio;
  exposure.peak_moment = joint.peak.deciding_moment;
  exposure.peak_capacity = joint.peak.capacity;
  exposure.peak_channel = joint.peak.channel;
  exposure.peak_stamp_nanos = joint.peak_stamp_nanos;
  return exposure;
}

double Exposure::secs() const { return Secs(counted_nanos_); }

}  // namespace kinescope::loads
