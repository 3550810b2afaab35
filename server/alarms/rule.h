/// What raises an alarm. Plain values; any thread.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/load_class.h"

namespace kinescope::alarms {

enum class Quantity {
  kRatio,        // load ratio of a joint in a sample
  kClass,        // load class of a joint, as people see it
  kExposure,     // share of the time since the start in which a joint was in a class
  kCompression,  // of L5/S1, N
  kMargin,       // margin of stability, m; too small is what raises
  kLoss,         // share of the stream's samples that were lost or incomplete in the last 10 s
  kStale,        // time without a sample of a stream that had samples, s
  kLost,         // time without a sample of a person or of the stream, s; always watched
};

/// "ratio", "class", "exposure", "compression", "margin", "loss", "stale", "lost".
const char* Name(Quantity quantity);
/// Of its limit and band: "1" for shares, ratios and classes, "N", "m" or "s".
const char* UnitOf(Quantity quantity);
/// Whether each person has a value of their own.
bool IsOfPerson(Quantity quantity);

enum class Priority { kLow, kMedium, kHigh };

/// "low", "medium", "high".
const char* Name(Priority priority);

/// An alarm begins when the value has been beyond `limit` for `for_secs`, and is over when it has
/// been inside the limit by at least `band` for `over_secs`.
struct Rule {
  std::string name;
  Quantity quantity = Quantity::kRatio;
  std::optional<int> joint;  // urdf::Joint, one with a load; nullopt: the joint with the most
  LoadClass least_class = LoadClass::kHigh;  // of kClass: that raises; of kExposure: that counts
  double limit = 0;
  /// Of kRatio: the limit is where this class begins, and follows it; kUnknown: it stays.
  LoadClass limit_class = LoadClass::kUnknown;
  double band = 0;
  double band_share = 0;  // of the limit, if it follows a class; 0: the band stays
  double for_secs = 0;
  double over_secs = 1;
  Priority priority = Priority::kMedium;
  /// It stays until it is acknowledged, although it is over.
  bool latches = false;
};

struct Rules {
  std::vector<Rule> rules;
  double lost_secs = 2;  // of Quantity::kLost
  std::string webhook;   // URL that hears of every alarm; "": none
};

/// Sets the limit of a rule that follows a class.
/// @param class_limits the load ratios where medium and high begin
void FollowClassLimits(const std::array<double, 2>& class_limits, Rule& rule);

/// The rule that is always watched.
Rule LostRule(double lost_secs);

}  // namespace kinescope::alarms
