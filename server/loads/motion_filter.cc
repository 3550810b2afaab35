#include "server/loads/motion_filter.h"

#include <algorithm>
#include <cmath>

#include "core/system/clocks.h"

namespace kinescope::loads {
namespace {

using Eigen::Vector3d;

constexpr double kSegments = urdf::kSegmentCount;
constexpr double kMaxOfRate = 0.4;  // of the cut-off

struct Mean {
  Vector3d velocity = Vector3d::Zero(), acceleration = Vector3d::Zero();
};

Mean MeanOf(const BodySample& sample) {
  Mean mean;
  for (const SegmentState& segment : sample.segments) {
    mean.velocity += segment.velocity / kSegments;
    mean.acceleration += segment.acceleration / kSegments;
  }
  return mean;
}

bool HasMotion(const BodySample& sample) {
  constexpr double kMax = 1e9;  // larger values would stay in a filter too long
  double sum = 0;
  for (const SegmentState& segment : sample.segments) {
    sum += segment.velocity.cwiseAbs().sum() + segment.acceleration.cwiseAbs().sum() +
           segment.angular_velocity.cwiseAbs().sum() +
           segment.angular_acceleration.cwiseAbs().sum();
  }
  return sum < kMax;  // also false if one of them is NaN
}

Vector3d Shortened(const Vector3d& vector, double longest) {
  const double length = vector.norm();
  return length > longest ? Vector3d(vector * (longest / length)) : vector;
}

}  // namespace

std::string_view WhatIsMissing(const BodySample& sample) {
  if (!sample.has_linear && !sample.has_angular) return "the source sends only poses";
  if (!sample.has_linear) return "the source sends no linear accelerations";
  if (!sample.has_angular) return "the source sends no angular velocities";
  if (!HasMotion(sample)) return "accelerations are not finite or too large";
  return "";
}

double DelayOf(double step_secs, double cutoff_hz) {
  return std::sqrt(2.0) * step_secs /
         (2 * std::tan(M_PI * std::min(cutoff_hz * step_secs, kMaxOfRate)));
}

LowPassStep LowPassStep::OfTwoPasses(double step_secs, double cutoff_hz) {
  static const double correction = std::pow(std::sqrt(2.0) - 1, 0.25);
  return {step_secs, cutoff_hz, correction};
}

LowPassStep::LowPassStep(double step_secs, double cutoff_hz, double correction) {
  const double damping = std::sqrt(2.0);  // Butterworth
  const double g = std::tan(M_PI * std::min(cutoff_hz * step_secs, kMaxOfRate)) / correction;
  a1 = 1 / (1 + g * (g + damping));
  a2 = g * a1;
  a3 = g * a2;
  rate_of_band = 2 * g / step_secs;
}

void LowPass::Restart(const Vector3d& value) {
  value_ = low_ = value;
  rate_ = band_ = Vector3d::Zero();
}

void LowPass::Update(const Vector3d& value, const LowPassStep& step) {
  const Vector3d high = value - low_;
  const Vector3d band = step.a1 * band_ + step.a2 * high;
  value_ = low_ + step.a2 * band_ + step.a3 * high;
  rate_ = step.rate_of_band * band;
  band_ = 2 * band - band_;
  low_ = 2 * value_ - low_;
}

void MotionFilter::Restart(const BodySample& sample) {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const SegmentState& segment = sample.segments[i];
    channels_[i].acceleration.Restart(segment.acceleration);
    channels_[i].angular_velocity.Restart(segment.angular_velocity);
    channels_[i].angular_acceleration.Restart(segment.angular_acceleration);
    channels_[i].velocity.Restart(segment.velocity);
    last_orientation_[i] = segment.orientation;
  }
  linear_is_streamed_ = angular_is_streamed_ = false;
  last_velocity_ = MeanOf(sample).velocity;
  velocity_excess_ = Vector3d::Zero();
  turned_ = claimed_turn_ = 0;
}

void MotionFilter::Filter(const BodySample& sample, const LowPassStep& step) {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const SegmentState& segment = sample.segments[i];
    channels_[i].acceleration.Update(segment.acceleration, step);
    channels_[i].angular_velocity.Update(segment.angular_velocity, step);
    channels_[i].angular_acceleration.Update(segment.angular_acceleration, step);
    channels_[i].velocity.Update(segment.velocity, step);
  }
}

void MotionFilter::Compare(const BodySample& sample, double step_secs) {
  constexpr double kMemorySecs = 1;
  const double kept = std::exp(-step_secs / kMemorySecs);
  const Mean mean = MeanOf(sample);
  velocity_excess_ =
      kept * velocity_excess_ + step_secs * mean.acceleration - (mean.velocity - last_velocity_);
  last_velocity_ = mean.velocity;
  turned_ *= kept;
  claimed_turn_ *= kept;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const SegmentState& segment = sample.segments[i];
    // Twice the sine of half the angle: accurate enough for a comparison by factors.
    turned_ += 2 * (last_orientation_[i].conjugate() * segment.orientation).vec().norm();
    claimed_turn_ += segment.angular_velocity.norm() * step_secs;
    last_orientation_[i] = segment.orientation;
  }
}

std::string_view MotionFilter::Doubt() const {
  constexpr double kMaxExcess = 3;  // m/s within a second; gravity included would make 9.8
  constexpr double kMaxFactor = 5;  // degrees would make 57
  constexpr double kMaxTurnOfNoise = 0.2 * kSegments;  // rad within a second
  if (linear_is_streamed_ && velocity_excess_.norm() > kMaxExcess) {
    return "accelerations are inconsistent with the velocities";
  }
  if (claimed_turn_ > kMaxFactor * turned_ + kMaxTurnOfNoise) {
    return "angular velocities are inconsistent with the poses";
  }
  return "";
}

void MotionFilter::Fill(const Settings& settings) {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const Channels& channel = channels_[i];
    SegmentMotion& motion = output_.motion[i];
    motion.acceleration =
        linear_is_streamed_ ? channel.acceleration.value() : channel.velocity.rate();
    motion.angular_velocity = channel.angular_velocity.value();
    motion.angular_acceleration =
        Shortened(angular_is_streamed_ ? channel.angular_acceleration.value()
                                       : channel.angular_velocity.rate(),
                  settings.most_angular_acceleration);
  }
  output_.is_dynamic = true;
  output_.why_static = "";
}

const MotionFilter::Output& MotionFilter::BecomeStatic(std::string_view why) {
  output_ = Output();
  output_.why_static = why;
  return output_;
}

const MotionFilter::Output& MotionFilter::Update(const BodySample& sample,
                                                 const Settings& settings) {
  const double step_secs = Secs(sample.stamp_nanos - last_nanos_);
  const bool continues = has_last_ && step_secs >= 0 && step_secs <= settings.longest_gap_secs;
  if (!settings.dynamic) {
    has_last_ = false;
    return BecomeStatic("static loads were requested");
  }
  if (const std::string_view missing = WhatIsMissing(sample); !missing.empty()) {
    if (continues) return output_;
    has_last_ = false;
    return BecomeStatic(missing);
  }
  if (continues && step_secs == 0) return output_;
  if (continues) {
    Filter(sample, LowPassStep(step_secs, settings.cutoff_hz));
    output_.delay_secs = DelayOf(step_secs, settings.cutoff_hz);
    Compare(sample, step_secs);
  } else {
    Restart(sample);
  }
  has_last_ = true;
  last_nanos_ = sample.stamp_nanos;
  for (const SegmentState& segment : sample.segments) {
    linear_is_streamed_ |= !segment.acceleration.isZero(0);
    angular_is_streamed_ |= !segment.angular_acceleration.isZero(0);
  }
  if (const std::string_view doubt = Doubt(); !doubt.empty()) return BecomeStatic(doubt);
  Fill(settings);
  return output_;
}

}  // namespace kinescope::loads
