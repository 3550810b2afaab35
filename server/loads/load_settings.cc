#include "server/loads/load_settings.h"

#include <fmt/format.h>

#include <cmath>

#include "core/system/errors.h"

namespace kinescope::loads {
namespace {

std::string OutOf(const char* what, double value, double least, double most, const char* unit) {
  if (value >= least && value <= most) return "";
  return fmt::format("{} {}: expected {} to {}{}", what, value, least, most, unit);
}

std::string FindDefect(const LoadMeter::Settings& classes) {
  const auto [orange, red] = classes.up;
  const auto [green, back_to_orange] = classes.down;
  const bool ordered = green > 0 && green <= orange && orange < red && back_to_orange <= red &&
                       green <= back_to_orange && std::isfinite(red);
  if (ordered) return "";
  return fmt::format(
      "class limits up {} {}, down {} {}: expected 0 < down <= up for both, the second above the "
      "first",
      orange, red, green, back_to_orange);
}

}  // namespace

std::string FindDefect(const LoadSettings& settings) {
  for (std::string defect :
       {FindDefect(settings.strength), FindDefect(settings.hands), FindDefect(settings.meter),
        OutOf("cut-off frequency of accelerations", settings.motion.cutoff_hz, 1, 30, " Hz"),
        OutOf("cut-off frequency of recorded accelerations", settings.motion.recording_cutoff_hz, 1,
              30, " Hz"),
        OutOf("acceleration limit", settings.most_acceleration, 1, 1000, " m/s^2"),
        OutOf("ramp of foot contacts", settings.contact.ramp_secs, 0, 1, " s")}) {
    if (!defect.empty()) return defect;
  }
  return "";
}

}  // namespace kinescope::loads
