#include "server/alarms/rule.h"

namespace kinescope::alarms {

const char* Name(Quantity quantity) {
  switch (quantity) {
    case Quantity::kRatio: return "ratio";
    case Quantity::kClass: return "class";
    case Quantity::kExposure: return "exposure";
    case Quantity::kCompression: return "compression";
    case Quantity::kMargin: return "margin";
    case Quantity::kLoss: return "loss";
    case Quantity::kStale: return "stale";
    case Quantity::kLost: return "lost";
  }
  return "";
}

const char* UnitOf(Quantity quantity) {
  switch (quantity) {
    case Quantity::kCompression: return "N";
    case Quantity::kMargin: return "m";
    case Quantity::kStale:
    case Quantity::kLost: return "s";
    default: return "1";
  }
}

bool IsOfPerson(Quantity quantity) {
  return quantity != Quantity::kLoss && quantity != Quantity::kStale;
}

const char* Name(Priority priority) {
  switch (priority) {
    case Priority::kLow: return "low";
    case Priority::kMedium: return "medium";
    case Priority::kHigh: return "high";
  }
  return "";
}

void FollowClassLimits(const std::array<double, 2>& class_limits, Rule& rule) {
  if (rule.limit_class == LoadClass::kUnknown) return;
  rule.limit = class_limits[rule.limit_class == LoadClass::kHigh ? 1 : 0];
  if (rule.band_share > 0) rule.band = rule.band_share * rule.limit;
}

Rule LostRule(double lost_secs) {
  Rule rule;
  rule.name = "lost";
  rule.quantity = Quantity::kLost;
  rule.limit = lost_secs;
  rule.priority = Priority::kHigh;
  rule.over_secs = 0;
  return rule;
}

}  // namespace kinescope::alarms
