#include "server/app/serve/stream_health.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/system/json_text.h"
#include "server/app/serve/clock_news.h"

namespace kinescope::app {
namespace {

using nlohmann::json;

constexpr double kJitterShare = 0.95;

// The events since the last call.
std::uint64_t Advance(std::uint64_t count, std::int64_t now_nanos, StreamHealth::Events& events) {
  const std::uint64_t since = count - events.count;
  if (since > 0) events.last_nanos = now_nanos;
  events.count = count;
  return since;
}

std::optional<double> ShareOf(double lost, double incomplete, double samples) {
  if (lost + samples <= 0) return std::nullopt;
  return (lost + incomplete) / (lost + samples);
}

json EventsToJson(const StreamHealth::Events& events) {
  return {{"count", events.count},
          {"count_10s", events.recent},
          {"last_micros", events.last_nanos == 0 ? json(nullptr) : json(events.last_nanos / 1000)}};
}

}  // namespace

void StreamHealthMeter::OnCounters(const SourceCounters& counters, std::int64_t now_nanos) {
  Slice slice;
  slice.end_nanos = now_nanos;
  slice.samples = counters.samples - std::exchange(health_.samples, counters.samples);
  slice.lost = static_cast<double>(counters.lost - std::exchange(health_.lost, counters.lost));
  slice.gaps = Advance(counters.counter_gaps, now_nanos, health_.gaps);
  for (const auto& [reason, count] : counters.rejected) {
    const std::uint64_t since = Advance(count, now_nanos, health_.rejected[reason]);
    if (since > 0) slice.rejected[reason] = since;
  }
  slice.delays = counters.delays;
  health_.clocks = counters.clocks;
  slice.incomplete = Advance(counters.incomplete, now_nanos, health_.incomplete);
  const auto steps = counters.transport.find("clock_steps");
  if (steps != counters.transport.end()) {
    slice.clock_steps = Advance(steps->second, now_nanos, health_.clock_steps);
  }
  health_.loss =
      ShareOf(static_cast<double>(health_.lost), static_cast<double>(health_.incomplete.count),
              static_cast<double>(health_.samples));
  slices_.push_back(std::move(slice));
  SpreadLosses();
  while (now_nanos - slices_.front().end_nanos >= StreamHealth::kRecentNanos) {
    delays_then_ = slices_.front().delays;
    slices_.pop_front();
  }
  SumUp();
}

// The losses of the last slice also happened in the silent ones before it.
void StreamHealthMeter::SpreadLosses() {
  const double lost = slices_.back().lost;
  if (slices_.back().samples == 0 && lost == 0) {
    ++silent_;
    return;
  }
  const std::uint64_t parts = std::exchange(silent_, 0) + 1;
  const double each = lost / static_cast<double>(parts);
  std::uint64_t left = parts;
  for (auto slice = slices_.rbegin(); slice != slices_.rend() && left > 0; ++slice, --left) {
    slice->lost = each;
  }
}

void StreamHealthMeter::SumUp() {
  double samples = 0, lost = 0;
  health_.gaps.recent = health_.incomplete.recent = health_.clock_steps.recent = 0;
  for (auto& [reason, events] : health_.rejected) events.recent = 0;
  for (const Slice& slice : slices_) {
    samples += static_cast<double>(slice.samples);
    lost += slice.lost;
    health_.gaps.recent += slice.gaps;
    health_.incomplete.recent += slice.incomplete;
    health_.clock_steps.recent += slice.clock_steps;
    for (const auto& [reason, count] : slice.rejected) health_.rejected[reason].recent += count;
  }
  const auto incomplete = static_cast<double>(health_.incomplete.recent);
  health_.recent_loss = samples > 0 ? ShareOf(lost, incomplete, samples) : std::nullopt;
  const DurationHistogram delays = slices_.back().delays.Since(delays_then_);
  health_.jitter.reset();
  if (delays.total() > 0) health_.jitter = delays.PercentileNanos(kJitterShare);
}

std::string StreamHealthJson(const StreamHealth& health) {
  json rejected = json::array();
  for (const auto& [reason, events] : health.rejected) {
    json entry = EventsToJson(events);
    entry["reason"] = reason;
    rejected.push_back(std::move(entry));
  }
  json clocks = json::array();
  for (const NodeClock& clock : health.clocks) clocks.push_back(ClockJson(clock));
  return JsonText(json{
      {"samples", health.samples},
      {"lost", health.lost},
      {"incomplete", EventsToJson(health.incomplete)},
      {"clock_steps", EventsToJson(health.clock_steps)},
      {"loss_10s", health.recent_loss ? json(Rounded(*health.recent_loss, 1e4)) : json(nullptr)},
      {"loss", health.loss ? json(Rounded(*health.loss, 1e6)) : json(nullptr)},
      {"jitter_ms", health.jitter ? json(Rounded(1e-6 * static_cast<double>(*health.jitter), 10))
                                  : json(nullptr)},
      {"gaps", EventsToJson(health.gaps)},
      {"rejected", std::move(rejected)},
      {"clocks", std::move(clocks)}});
}

}  // namespace kinescope::app
