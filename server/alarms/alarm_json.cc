#include "server/alarms/alarm_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/system/json_text.h"

namespace kinescope::alarms {
namespace {

using nlohmann::json;

constexpr std::size_t kMostShown = 100;  // in a message

// What can be read of it, so that a value that hardly changes gives the same text.
double Rounded(double value) { return std::round(value * 1e3) / 1e3; }

json ValueJson(const Rule& rule, double value) {
  if (rule.quantity == Quantity::kClass) {
    return Name(static_cast<LoadClass>(std::lround(value)));
  }
  return Rounded(value);
}

json MomentJson(const Moment& moment) {
  return {{"state", moment.state},
          {"micros", moment.made_nanos / 1000},
          {"stamp_micros", moment.stamp_nanos / 1000}};
}

json JointJson(const std::optional<int>& joint) {
  return joint ? json(urdf::kJoints[urdf::At(*joint)].ros_name) : json(nullptr);
}

json AlarmsJson(const std::vector<Alarm>& alarms, std::size_t most) {
  json list = json::array();
  for (const Alarm& alarm : alarms) {
    if (list.size() >= most) break;
    list.push_back(ToJson(alarm));
  }
  return list;
}

}  // namespace

json ToJson(const Alarm& alarm) {
  json all = {{"id", alarm.id},
              {"rule", alarm.rule.name},
              {"priority", Name(alarm.rule.priority)},
              {"quantity", Name(alarm.rule.quantity)},
              {"unit", UnitOf(alarm.rule.quantity)},
              {"limit", ValueJson(alarm.rule, alarm.rule.limit)},
              {"person", alarm.character ? json(*alarm.character) : json(nullptr)},
              {"name", alarm.person},
              {"joint", JointJson(alarm.joint)},
              {"value", ValueJson(alarm.rule, alarm.value)},
              {"worst", ValueJson(alarm.rule, alarm.worst)},
              {"text", Describe(alarm)},
              {"times", alarm.times},
              {"began", MomentJson(alarm.began)},
              {"over", alarm.over ? MomentJson(*alarm.over) : json(nullptr)},
              {"is_on", alarm.is_on()},
              {"is_shown", alarm.is_shown()},
              {"acknowledged", nullptr}};
  if (alarm.acknowledged) {
    all["acknowledged"] = {{"role", alarm.acknowledged->role},
                           {"micros", alarm.acknowledged->nanos / 1000}};
  }
  return all;
}

json ToJson(const Rule& rule) {
  json all = {
      {"name", rule.name},    {"value", Name(rule.quantity)}, {"unit", UnitOf(rule.quantity)},
      {"for", rule.for_secs}, {"over_after", rule.over_secs}, {"priority", Name(rule.priority)},
      {"latch", rule.latches}};
  switch (rule.quantity) {
    case Quantity::kClass:
      all["at_least"] = Name(rule.least_class);
      all["joint"] = rule.joint ? JointJson(rule.joint) : json("any");
      return all;
    case Quantity::kExposure: all["of"] = Name(rule.least_class); [[fallthrough]];
    case Quantity::kRatio: all["joint"] = rule.joint ? JointJson(rule.joint) : json("any"); break;
    default: break;
  }
  all[rule.quantity == Quantity::kMargin ? "below" : "above"] = rule.limit;
  if (rule.limit_class != LoadClass::kUnknown) all["above_class"] = Name(rule.limit_class);
  all["band"] = rule.band;
  return all;
}

std::string ShownJson(const Alarms& alarms) {
  const std::vector<Alarm> shown = alarms.shown();
  const std::vector<Alarm> last = alarms.log(1);
  return JsonText(json{{"shown", AlarmsJson(shown, kMostShown)},
                       {"count", shown.size()},
                       {"last", last.empty() ? json(nullptr) : ToJson(last.front())}});
}

std::string NewsJson(const Alarm& alarm, Change change) {
  const std::string text = alarm.rule.name + " " + Name(change) + ": " + Describe(alarm);
  return JsonText(json{{"text", text}, {"change", Name(change)}, {"alarm", ToJson(alarm)}});
}

std::string LogJson(const Alarms& alarms) {
  json rules = json::array();
  for (const Rule& rule : alarms.rules()) rules.push_back(ToJson(rule));
  return JsonText(json{{"rules", std::move(rules)},
                       {"tells_webhook", alarms.tells_webhook()},
                       {"alarms", AlarmsJson(alarms.log(Alarms::kMostKept), Alarms::kMostKept)}});
}

}  // namespace kinescope::alarms
