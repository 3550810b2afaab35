#include "server/loads/zero_phase_filter.h"

#include <algorithm>

#include "core/system/clocks.h"

namespace kinescope::loads {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kExtension = 9;                      // samples, at either end
constexpr std::int64_t kAheadNanos = kNanosPerSecond;      // of the backward pass
constexpr std::int64_t kBlockNanos = 2 * kNanosPerSecond;  // of moments that wait

}  // namespace

void ZeroPhaseFilter::Pass(const Values& values, double secs, Bank& bank) const {
  const LowPassStep step = LowPassStep::OfTwoPasses(secs, cutoff_hz_);
  for (std::size_t i = 0; i < kChannels; ++i) bank[i].Update(values[i], step);
}

void ZeroPhaseFilter::Restart(const Values& values, Bank& bank) {
  for (std::size_t i = 0; i < kChannels; ++i) bank[i].Restart(values[i]);
}

ZeroPhaseFilter::Values ZeroPhaseFilter::ValuesOf(const Bank& bank) {
  Values values;
  for (std::size_t i = 0; i < kChannels; ++i) values[i] = bank[i].value();
  return values;
}

double ZeroPhaseFilter::StepBefore(std::size_t moment) const {
  return Secs(moments_[moment].stamp_nanos - moments_[moment - 1].stamp_nanos);
}

void ZeroPhaseFilter::Add(const BodySample& sample) {
  Moment& moment = moments_.emplace_back();
  moment.stamp_nanos = sample.stamp_nanos;
  for (std::size_t i = 0; i < sample.segments.size(); ++i) {
    const SegmentState& segment = sample.segments[i];
    Vector3d* const raw = &moment.raw[i * kKinds];
    raw[kAcceleration] = segment.acceleration;
    raw[kAngularVelocity] = segment.angular_velocity;
    raw[kAngularAcceleration] = segment.angular_acceleration;
    raw[kVelocity] = segment.velocity;
    linear_is_streamed_ |= !segment.acceleration.isZero(0);
    angular_is_streamed_ |= !segment.angular_acceleration.isZero(0);
  }
  if (has_started_) {
    Pass(moment.raw, StepBefore(moments_.size() - 1), state_);
    moment.forward = ValuesOf(state_);
  } else if (moments_.size() > kExtension) {
    Start();
  }
  const std::int64_t newest = moments_.back().stamp_nanos;
  if (!has_started_ || newest - moments_.front().stamp_nanos < kBlockNanos) return;
  std::size_t count = 0;
  while (moments_[count].stamp_nanos <= newest - kAheadNanos) ++count;
  Emit(count, Backward(false));
}

// The forward pass begins with the extension of the first moment.
void ZeroPhaseFilter::Start() {
  const std::size_t extension = std::min(kExtension, moments_.size() - 1);
  const auto mirrored = [&](std::size_t i) {
    Values values;
    for (std::size_t c = 0; c < kChannels; ++c) {
      values[c] = 2 * moments_[0].raw[c] - moments_[i].raw[c];
    }
    return values;
  };
  Restart(mirrored(extension), state_);
  for (std::size_t i = extension; i-- > 1;) Pass(mirrored(i), StepBefore(i + 1), state_);
  for (std::size_t i = 0; i < moments_.size(); ++i) {
    if (i > 0 || extension > 0) {
      Pass(moments_[i].raw, StepBefore(std::max<std::size_t>(i, 1)), state_);
    }
    moments_[i].forward = ValuesOf(state_);
  }
  has_started_ = true;
}

// By moment. After the end, the pass begins with the extension of the last one.
std::vector<ZeroPhaseFilter::Values> ZeroPhaseFilter::Backward(bool has_ended) const {
  const std::size_t last = moments_.size() - 1;
  Bank bank;
  Restart(moments_[last].forward, bank);
  const std::size_t extension = has_ended ? std::min(kExtension, last) : 0;
  if (extension > 0) {
    Bank onward = state_;
    std::vector<Values> beyond;
    for (std::size_t j = 1; j <= extension; ++j) {
      Values values;
      for (std::size_t c = 0; c < kChannels; ++c) {
        values[c] = 2 * moments_[last].raw[c] - moments_[last - j].raw[c];
      }
      Pass(values, StepBefore(last - j + 1), onward);
      beyond.push_back(ValuesOf(onward));
    }
    Restart(beyond.back(), bank);
    for (std::size_t j = extension; j-- > 1;) Pass(beyond[j - 1], StepBefore(last - j), bank);
    Pass(moments_[last].forward, StepBefore(last), bank);
  }
  std::vector<Values> values(moments_.size());
  values[last] = ValuesOf(bank);
  for (std::size_t i = last; i-- > 0;) {
    Pass(moments_[i].forward, StepBefore(i + 1), bank);
    values[i] = ValuesOf(bank);
  }
  return values;
}

void ZeroPhaseFilter::Emit(std::size_t count, const std::vector<Values>& values) {
  // Slope of channel `c` at moment `i`, from its neighbours.
  const auto slope = [&](std::size_t i, std::size_t c) -> Vector3d {
    const bool has_before = i > 0 || last_out_, has_after = i + 1 < values.size();
    const Vector3d& before = i > 0       ? values[i - 1][c]
                             : last_out_ ? last_out_->forward[c]
                                         : values[i][c];
    const Vector3d& after = has_after ? values[i + 1][c] : values[i][c];
    const std::int64_t from = i > 0        ? moments_[i - 1].stamp_nanos
                              : has_before ? last_out_->stamp_nanos
                                           : moments_[i].stamp_nanos;
    const std::int64_t to = moments_[has_after ? i + 1 : i].stamp_nanos;
    return to > from ? Vector3d((after - before) / Secs(to - from)) : Vector3d::Zero();
  };
  for (std::size_t i = 0; i < count; ++i) {
    BodyMotion& motion = ready_.emplace_back();
    for (std::size_t s = 0; s < motion.size(); ++s) {
      const std::size_t channel = s * kKinds;
      motion[s].acceleration =
          linear_is_streamed_ ? values[i][channel + kAcceleration] : slope(i, channel + kVelocity);
      motion[s].angular_velocity = values[i][channel + kAngularVelocity];
      motion[s].angular_acceleration = angular_is_streamed_
                                           ? values[i][channel + kAngularAcceleration]
                                           : slope(i, channel + kAngularVelocity);
    }
  }
  last_out_ = Moment{moments_[count - 1].stamp_nanos, {}, values[count - 1]};
  moments_.erase(moments_.begin(), moments_.begin() + static_cast<std::ptrdiff_t>(count));
}

void ZeroPhaseFilter::End() {
  if (!moments_.empty()) {
    if (!has_started_) Start();
    Emit(moments_.size(), Backward(true));
  }
  has_started_ = false;
  last_out_.reset();
  linear_is_streamed_ = angular_is_streamed_ = false;
}

}  // namespace kinescope::loads
