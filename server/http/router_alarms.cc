// The routes of alarms.
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "core/system/json_parse.h"
#include "core/system/json_text.h"
#include "server/alarms/alarm_json.h"
#include "server/http/router.h"

namespace kinescope::http {
namespace {

using nlohmann::json;

constexpr char kNoAlarms[] = "this server watches no alarms";
constexpr char kExpectedAcknowledgement[] = R"(expected {"id": NUMBER}, of an alarm that is shown)";

}  // namespace

Answer Router::Alarms(const Request& /*request*/, Role /*role*/) const {
  if (site_.alarms == nullptr) return Refuse(503, "no alarms", kNoAlarms);
  return JsonAnswer(alarms::LogJson(*site_.alarms));
}

Answer Router::Acknowledge(const Request& request, Role role) const {
  if (auto refusal = RefuseUnlessJson(request, "acknowledge alarms")) return *std::move(refusal);
  if (site_.alarms == nullptr) return Refuse(503, "no alarms", kNoAlarms);
  if (!request.body) return AskForBody();
  const json order = ParseJson(*request.body);
  const auto id = order.is_object() ? order.find("id") : order.end();
  if (!order.is_object() || order.size() != 1 || id == order.end() || !id->is_number_unsigned()) {
    return Refuse(400, "bad acknowledgement", kExpectedAcknowledgement);
  }
  const auto alarm = site_.alarms->Acknowledge(id->get<std::uint64_t>(), std::string(Name(role)));
  if (!alarm) return Refuse(409, "not acknowledged", alarm.error());
  return JsonAnswer(JsonText(ToJson(*alarm)));
}

}  // namespace kinescope::http
