#include "server/ros/source/publisher_clock.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace kinescope::ros_bridge {
namespace {

constexpr std::int64_t kStep = 1'000;  // equal stamps are the same sample
constexpr std::int64_t kMostExcess = 10'000'000'000;
constexpr std::int64_t kDriftsIn = 10'000;  // by 1 at most: 0.1 ms per s, of two clocks

// Of their clock from this computer's, as if both ways took equally long.
std::int64_t OffsetOf(const RoundTrip& trip) {
  return trip.theirs - trip.sent - (trip.received - trip.sent) / 2;
}

// Half of the round trip, and what the clocks may have drifted since.
std::int64_t UncertaintyOf(const RoundTrip& trip, std::int64_t now) {
  const std::int64_t age = std::max<std::int64_t>(0, now - trip.received);
  return (trip.received - trip.sent + 1) / 2 + age / kDriftsIn;
}

}  // namespace

void PublisherClock::Lags::Add(std::int64_t lag) {
  least = std::min(least.value_or(lag), lag);
  most = std::max(most.value_or(lag), lag);
}

void PublisherClock::Lags::Add(const Lags& lags) {
  if (!lags.least) return;
  Add(*lags.least);
  Add(*lags.most);
}

PublisherClock::Lags PublisherClock::Recent() const {
  Lags all = before_;
  all.Add(now_);
  return all;
}

void PublisherClock::OnStamp(std::int64_t stamp, std::int64_t arrival) {
  if (newest_ == stamp) {  // repeated: it says nothing about the time
    heard_ = arrival;
    return;
  }
  const std::int64_t lag = arrival - stamp;
  const std::optional<std::int64_t> least = Recent().least;
  const bool was_set = newest_ && (stamp < *newest_ - kBack || (least && lag < *least - kAdvance));
  if (was_set) {
    before_ = now_ = {};
    best_.reset();
  }
  if (was_set || !newest_ || arrival < window_begin_) {
    window_begin_ = arrival;
  } else if (arrival - window_begin_ >= kWindow) {
    // Only a full window counts: after an outage, old messages come first.
    before_ = std::exchange(now_, {});
    window_begin_ = arrival;
  }
  now_.Add(lag);
  heard_ = arrival;
  if (newest_ && stamp > *newest_) {
    excess_ = std::max<std::int64_t>(0, excess_ - (stamp - *newest_) / 10);
  }
  Decide(stamp, was_set);
  newest_ = was_set || !newest_ ? stamp : std::max(*newest_, stamp);
  newest_shifted_ = *newest_ + shift();
}

void PublisherClock::OnRoundTrip(const RoundTrip& trip) {
  tells_time_ = true;
  if (best_) {
    const std::int64_t of_best = UncertaintyOf(*best_, trip.received);
    const std::int64_t of_trip = UncertaintyOf(trip, trip.received);
    const bool was_set = std::abs(OffsetOf(*best_) - OffsetOf(trip)) > of_best + of_trip;
    if (was_set) before_ = now_ = {};
    if (!was_set && of_best < of_trip) return;
  }
  best_ = trip;
}

void PublisherClock::OnOwnClockSet(std::int64_t by) {
  before_ = now_ = {};
  newest_.reset();
  shift_ = excess_ = 0;
  heard_ += by;
  if (!best_) return;
  best_->sent += by;
  best_->received += by;
}

PublisherClock::Behind PublisherClock::FindBehind() const {
  const std::int64_t lag = *Recent().least;
  // Stamps may be late by any delay, but not ahead of the clock that answers.
  const bool is_of_clock = best_ && lag + OffsetOf(*best_) > -kAheadOfAnswer;
  return is_of_clock ? Behind{-OffsetOf(*best_), kAccepted} : Behind{lag, kAcceptedUnasked};
}

void PublisherClock::Decide(std::int64_t stamp, bool was_set) {
  // Stamps alone do not tell a clock from a network, a relay or a recording that is played.
  if (!tells_time_) return;
  const Behind behind = FindBehind();
  const bool is_far = std::abs(behind.nanos) >= NodeClock::kFarNanos;
  const std::int64_t wanted = is_far ? 0 : behind.nanos;
  const bool is_wrong = std::abs(wanted - shift_) > behind.accepted;
  if (is_wrong) shift_ = std::abs(wanted) <= behind.accepted / 2 ? 0 : wanted;
  if (!is_wrong && !was_set) return;
  const std::int64_t back = newest_ && !is_far ? newest_shifted_ + kStep - (stamp + shift_) : 0;
  excess_ = std::clamp<std::int64_t>(back, 0, kMostExcess);
}

NodeClock PublisherClock::Report(std::string node, std::int64_t now) const {
  const Lags lags = Recent();
  NodeClock clock{
      std::move(node), lags.least.value_or(0), lags.most.value_or(0), std::nullopt, shift(),
      excess_};
  if (best_) clock.offset = {OffsetOf(*best_), UncertaintyOf(*best_, now)};
  return clock;
}

}  // namespace kinescope::ros_bridge
