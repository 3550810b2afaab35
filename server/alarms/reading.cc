#include "server/alarms/reading.h"

#include <cmath>

#include "server/alarms/watch.h"

namespace kinescope::alarms {
namespace {

// Shares of less time say little: the first raised arm would be 100 %.
constexpr double kLeastExposureSecs = 60;

std::optional<double> ExposureOf(const JointLoad& load, LoadClass least) {
  double known = 0, counted = 0;
  for (const LoadClass each : {LoadClass::kLow, LoadClass::kMedium, LoadClass::kHigh}) {
    const double secs = load.band_secs[static_cast<std::size_t>(each)];
    known += secs;
    if (each >= least) counted += secs;
  }
  if (known < kLeastExposureSecs) return std::nullopt;
  return counted / known;
}

std::optional<double> ValueOf(const Rule& rule, const JointLoad& load) {
  switch (rule.quantity) {
    case Quantity::kRatio:
      if (!std::isfinite(load.ratio)) return std::nullopt;
      return load.ratio;
    case Quantity::kClass:
      if (load.load_class == LoadClass::kUnknown) return std::nullopt;
      return static_cast<double>(load.load_class);
    default: return ExposureOf(load, rule.least_class);
  }
}

Reading WorstOf(const Rule& rule, const PersonState& person, std::optional<int> joint_of_alarm) {
  Reading worst;
  bool is_hidden = false;  // the joint of the alarm is unknown
  for (const JointLoad& load : person.loads) {
    if (rule.joint && *rule.joint != load.joint) continue;
    const std::optional<double> value = ValueOf(rule, load);
    if (!value) {
      is_hidden = is_hidden || joint_of_alarm == load.joint;
    } else if (!worst.value || *value > *worst.value) {
      worst = {value, load.joint};
    }
  }
  if (is_hidden && worst.value && !IsBeyond(rule, *worst.value)) return {};
  return worst;
}

}  // namespace

Reading ReadingOf(const Rule& rule, const SceneState& state, const PersonState& person,
                  std::optional<int> joint_of_alarm) {
  const bool is_live = state.liveness == Liveness::kLive;
  switch (rule.quantity) {
    case Quantity::kCompression:
      if (!is_live || !person.forces.lumbar) return {};
      return {person.forces.lumbar->compression, std::nullopt};
    case Quantity::kMargin:
      // A chair or a wall holds people whose margin says that they fall.
      if (!is_live || person.forces.external_contact_suspected) return {};
      return {person.forces.margin_of_stability, std::nullopt};
    default: return WorstOf(rule, person, joint_of_alarm);
  }
}

}  // namespace kinescope::alarms
