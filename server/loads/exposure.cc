#include "server/loads/exposure.h"

#include <algorithm>
#include <cmath>

#include "core/system/check.h"
#include "core/system/clocks.h"
#include "core/unknown.h"

namespace kinescope::loads {
namespace {

std::size_t IndexOf(LoadClass band) { return static_cast<std::size_t>(band); }

bool IsAbove(LoadClass band, std::size_t limit) {
  return band == LoadClass::kHigh || (band == LoadClass::kMedium && limit == 0);
}

}  // namespace

void BandTimes::Add(const std::array<JointLoad, urdf::kScoredJointCount>& loads,
                    std::int64_t stamp_nanos) {
  const std::int64_t nanos = times_.Add(stamp_nanos);
  for (std::size_t i = 0; i < loads.size(); ++i) {
    nanos_[i][IndexOf(last_[i])] += nanos;
    last_[i] = loads[i].band;
  }
}

std::array<double, kLoadClassCount> BandTimes::SecsOf(std::size_t scored_joint) const {
  KINESCOPE_CHECK(scored_joint < nanos_.size());
  std::array<double, kLoadClassCount> secs;
  for (std::size_t i = 0; i < secs.size(); ++i) secs[i] = Secs(nanos_[scored_joint][i]);
  return secs;
}

double Exposure::CountLast(std::int64_t nanos) {
  counted_nanos_ += nanos;
  for (Joint& joint : joints_) {
    joint.nanos[IndexOf(joint.last_band)] += nanos;
    for (std::size_t i = 0; i < joint.limits.size(); ++i) {
      Limit& limit = joint.limits[i];
      limit.hold_nanos = IsAbove(joint.last_band, i) ? limit.hold_nanos + nanos : 0;
      limit.longest_nanos = std::max(limit.longest_nanos, limit.hold_nanos);
    }
  }
  return Secs(nanos);
}

// Exposure counts a rise once, however the ratio trembles at the limit.
void Exposure::Cross(const JointLoad& load, Joint& joint) const {
  for (std::size_t i = 0; i < joint.limits.size(); ++i) {
    Limit& limit = joint.limits[i];
    if (!times_.continues()) {
      limit.side = Side::kUnknown;
      limit.hold_nanos = 0;
    }
    if (load.band == LoadClass::kUnknown) {
      limit.side = Side::kUnknown;
    } else if (IsAbove(load.band, i)) {
      if (limit.side == Side::kBelow) ++limit.rises;
      limit.side = Side::kAbove;
    } else if (limit.side != Side::kAbove || !(load.ratio >= limits_.down[i])) {
      limit.side = Side::kBelow;
    }
  }
}

double Exposure::Add(const std::vector<JointLoad>& loads, std::int64_t stamp_nanos) {
  KINESCOPE_CHECK(loads.size() == joints_.size());
  const double secs = CountLast(times_.Add(stamp_nanos));
  ++samples_;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    Joint& joint = joints_[i];
    const JointLoad& load = loads[i];
    Cross(load, joint);
    joint.last_band = load.band;
    ++joint.samples[IndexOf(load.band)];
    if (load.band == LoadClass::kUnknown || !std::isfinite(load.ratio)) continue;
    joint.ratios.push_back(load.ratio);
    if (joint.has_peak && load.ratio <= joint.peak.ratio) continue;
    joint.peak = load;
    joint.peak_stamp_nanos = stamp_nanos;
    joint.has_peak = true;
  }
  return secs;
}

double Exposure::Finish() { return CountLast(times_.Last()); }

JointExposure Exposure::Of(std::size_t scored_joint) const {
  KINESCOPE_CHECK(scored_joint < joints_.size());
  const Joint& joint = joints_[scored_joint];
  JointExposure exposure;
  exposure.samples = joint.samples;
  for (std::size_t i = 0; i < exposure.secs.size(); ++i) exposure.secs[i] = Secs(joint.nanos[i]);
  std::vector<double> ratios = joint.ratios;
  exposure.p10 = NearestRank(ratios, 10);
  exposure.p50 = NearestRank(ratios, 50);
  exposure.p90 = NearestRank(ratios, 90);
  double known_secs = 0;
  for (const LoadClass band : {LoadClass::kLow, LoadClass::kMedium, LoadClass::kHigh}) {
    known_secs += exposure.secs[IndexOf(band)];
  }
  constexpr double kSecsPerMin = 60;
  for (std::size_t i = 0; i < exposure.above.size(); ++i) {
    const Limit& limit = joint.limits[i];
    exposure.above[i] = {
        Secs(limit.longest_nanos), limit.rises,
        known_secs > 0 ? static_cast<double>(limit.rises) / known_secs * kSecsPerMin : kUnknown};
  }
  exposure.peak_ratio = joint.has_peak ? joint.peak.ratio : kUnknown;
  exposure.peak_moment = joint.peak.deciding_moment;
  exposure.peak_capacity = joint.peak.capacity;
  exposure.peak_channel = joint.peak.channel;
  exposure.peak_stamp_nanos = joint.peak_stamp_nanos;
  return exposure;
}

bool Exposure::IsEverKnown(std::size_t scored_joint) const {
  KINESCOPE_CHECK(scored_joint < joints_.size());
  return joints_[scored_joint].has_peak;
}

double Exposure::secs() const { return Secs(counted_nanos_); }

}  // namespace kinescope::loads
