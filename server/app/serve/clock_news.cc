#include "server/app/serve/clock_news.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "core/system/clocks.h"
#include "core/system/utf8.h"

namespace kinescope::app {
namespace {

using nlohmann::json;

constexpr std::int64_t kDiffers = 100 * kNanosPerMilli;
// Of stamps alone: a delay may be as long.
constexpr std::int64_t kLong = 500 * kNanosPerMilli;

std::string Time(std::int64_t nanos) {
  const double secs = std::abs(Secs(nanos));
  if (secs < 1) return fmt::format("{:.0f} ms", 1000 * secs);
  if (secs < 120) return fmt::format("{:.2f} s", secs);
  if (secs < 7200) return fmt::format("{:.0f} min", secs / 60);
  return secs < 172'800 ? fmt::format("{:.1f} h", secs / 3600)
                        : fmt::format("{:.0f} days", secs / 86'400);
}

// Rounded, so that a value that does not change gives the same text.
double Tenths(double millis) { return std::round(millis * 10) / 10; }

bool IsFar(std::int64_t nanos) { return std::abs(nanos) >= NodeClock::kFarNanos; }

std::string Consequence(const NodeClock& clock) {
  if (clock.offset && IsFar(clock.offset->nanos)) {
    return "until then the times of arrival are used here";
  }
  if (clock.shift_nanos == 0) return "until then its times are wrong by that";
  return "until then its times are corrected here, and in nothing that it records or "
         "publishes itself";
}

// "": it does not differ.
std::string DifferenceOf(const NodeClock& clock) {
  const std::string node = PrintableLine(clock.node);
  constexpr const char* kRemedy = "synchronise both with chrony or NTP";
  if (clock.offset) {
    const std::int64_t offset = clock.offset->nanos;
    if (std::abs(offset) - clock.offset->uncertainty_nanos <= kDiffers) return "";
    return fmt::format("the clock of {} is {} {} the server's: {}; {}", node, Time(offset),
                       offset < 0 ? "behind" : "ahead of", kRemedy, Consequence(clock));
  }
  const std::int64_t lag = clock.least_lag_nanos;
  if (IsFar(lag)) {
    return fmt::format(
        "the stamps of {} are {} {} the server's time: its clock was never set, or it plays a "
        "recording; the times of arrival are used",
        node, Time(lag), lag > 0 ? "behind" : "ahead of");
  }
  if (lag < -kDiffers) {
    return fmt::format("the clock of {} is at least {} ahead of the server's: {}; {}", node,
                       Time(lag), kRemedy, Consequence(clock));
  }
  if (lag <= kLong) return "";
  return fmt::format(
      "the stamps of {} are {} old when they arrive: its clock is behind the server's, or the "
      "network delays its messages; it does not tell which. If the clocks differ, {}; {}",
      node, Time(lag), kRemedy, Consequence(clock));
}

// While its stamps must not go back; "": they need not.
std::string SlownessOf(const NodeClock& clock) {
  if (clock.excess_nanos == 0) return "";
  return fmt::format(
      "the stamps of {} advance at 0.9 times the speed of time for {:.0f} s more: they were ahead, "
      "and none may go back",
      PrintableLine(clock.node), std::ceil(10 * Secs(clock.excess_nanos)));
}

}  // namespace

std::optional<Delay> DelayOf(const NodeClock& clock) {
  if (!clock.offset) return std::nullopt;
  return Delay{Millis(clock.least_lag_nanos + clock.offset->nanos),
               Millis(clock.most_lag_nanos + clock.offset->nanos)};
}

std::string ClockWarning(const NodeClock& clock) {
  const std::string difference = DifferenceOf(clock), slowness = SlownessOf(clock);
  return difference.empty() || slowness.empty() ? difference + slowness
                                                : difference + "; " + slowness;
}

json ClockJson(const NodeClock& clock) {
  const auto delay = DelayOf(clock);
  const auto of = [](bool is_known, double millis) {
    return is_known ? json(Tenths(millis)) : json(nullptr);
  };
  const auto offset = clock.offset.value_or(NodeClock::Offset{});
  return {{"node", clock.node},
          {"offset_ms", of(clock.offset.has_value(), Millis(offset.nanos))},
          {"uncertainty_ms", of(clock.offset.has_value(), Millis(offset.uncertainty_nanos))},
          {"delay_ms", of(delay.has_value(), delay.value_or(Delay{}).least_millis)},
          {"most_delay_ms", of(delay.has_value(), delay.value_or(Delay{}).most_millis)},
          {"lag_ms", Tenths(Millis(clock.least_lag_nanos))},
          {"most_lag_ms", Tenths(Millis(clock.most_lag_nanos))},
          {"shift_ms", Tenths(Millis(clock.shift_nanos))},
          {"excess_ms", Tenths(Millis(clock.excess_nanos))},
          {"warning", ClockWarning(clock)}};
}

}  // namespace kinescope::app
