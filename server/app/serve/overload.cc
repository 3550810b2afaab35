#include "server/app/serve/overload.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "core/scene_state.h"
#include "core/system/clocks.h"

namespace kinescope::app {
namespace {

constexpr std::int64_t kShownEvery = 50 * kNanosPerMilli;  // while it is behind
constexpr std::size_t kMostCharacters = 64;                // more are not in a stream at once
constexpr std::int64_t kSilence = 10 * kNanosPerSecond;    // between two lines of the log

}  // namespace

std::int64_t Overload::WaitedNanos(const BodySample& sample, std::int64_t now_nanos) {
  return sample.arrival_nanos == 0 ? 0
                                   : std::max<std::int64_t>(now_nanos - sample.arrival_nanos, 0);
}

void Overload::Log(std::int64_t waited_nanos, std::int64_t now_nanos) {
  const bool is_behind = waited_nanos > kOverloadNanos;
  if (is_behind == is_behind_) return;
  // A machine at its limit falls behind and catches up many times a second.
  if (is_behind && said_nanos_ != 0 && now_nanos - said_nanos_ < kSilence) return;
  is_behind_ = is_behind;
  said_nanos_ = now_nanos;
  if (is_behind) {
    skipped_before_ = skipped_;
    spdlog::warn("behind by {:.1f} s: this machine is too busy for the stream; {}",
                 Secs(waited_nanos),
                 may_skip_ ? "page and pictures skip samples to catch up"
                           : "every sample is still published to ROS");
  } else {
    spdlog::info("up to date again; {} samples were not shown", skipped_ - skipped_before_);
  }
}

bool Overload::Admit(int character, std::int64_t waited_nanos, std::int64_t now_nanos) {
  Log(waited_nanos, now_nanos);
  if (!may_skip_) return true;
  const auto last = admitted_nanos_.find(character);
  const bool is_old = waited_nanos > kOverloadNanos;
  if (is_old && last != admitted_nanos_.end() && now_nanos - last->second < kShownEvery) {
    ++skipped_;
    return false;
  }
  if (admitted_nanos_.size() >= kMostCharacters) admitted_nanos_.clear();
  admitted_nanos_[character] = now_nanos;
  return true;
}

}  // namespace kinescope::app
