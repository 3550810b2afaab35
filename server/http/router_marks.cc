// The routes of marks.
#include <charconv>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "core/system/json_text.h"
#include "server/http/mark_order.h"
#include "server/http/router.h"
#include "server/marks/mark_json.h"

namespace kinescope::http {
namespace {

using nlohmann::json;

constexpr std::size_t kMarksPerAnswer = 2000;  // about 1 MB

}  // namespace

Answer Router::Marks(const Request& request, Role role) const {
  if (site_.marks == nullptr || site_.history == nullptr) return Refuse(503, "no marks", kNoMarks);
  std::uint64_t after = 0;
  const auto target = ParseTarget(request.target);
  for (const auto& [name, value] : target->query) {
    if (name == "token") continue;
    const char* const last = value.data() + value.size();
    const auto [end, error] = std::from_chars(value.data(), last, after);
    if (name != "after" || error != std::errc() || end != last) {
      return Refuse(400, "bad marks", name + "=" + value + ": expected after=<a revision>");
    }
  }
  json marks = json::array();
  for (const marks::Mark& mark : site_.marks->ChangedAfter(after, kMarksPerAnswer)) {
    marks.push_back(ToJson(mark));
  }
  json answer = {{"names", site_.marks->names()},
                 {"run_micros", site_.marks->run_micros()},
                 {"revision", site_.marks->revision()},
                 {"marks", std::move(marks)}};
  // A viewer need not know the folders of this machine.
  if (role == Role::kOperator) answer["file"] = site_.marks->file().string();
  return JsonAnswer(JsonText(answer));
}

Answer Router::SetMark(const Request& request, Role role) const {
  if (auto refusal = RefuseUnlessJson(request, "set marks")) return *std::move(refusal);
  if (site_.marks == nullptr || site_.history == nullptr) return Refuse(503, "no marks", kNoMarks);
  if (!request.body) return AskForBody();
  const auto order = ParseMarkOrder(*request.body);
  if (!order) return Refuse(400, "bad mark", order.error());
  marks::Moment moment;
  if (order->state) {
    const auto state = site_.history->Numbered(*order->state);
    if (state == nullptr || state->number != *order->state || state->stamp_nanos == 0) {
      return RefuseMoment(*order->state, state.get());
    }
    moment = {state->number, state->made_nanos, state->stamp_nanos, state->time_code_millis,
              state->counter};
  }
  marks::MarkBook::Result result;
  if (!order->id) {
    const std::int64_t behind = site_.history->extent()->last_nanos - moment.made_nanos;
    result = site_.marks->Add({order->button, order->text, std::string(Name(role)), order->is_span,
                               moment, 1e-9 * static_cast<double>(behind)});
  } else {
    result = order->state ? site_.marks->End(*order->id, moment) : site_.marks->Remove(*order->id);
  }
  if (!result) return Refuse(409, "mark not kept", result.error());
  return JsonAnswer(JsonText(ToJson(*result)));
}

// `nearest`: the kept state whose number is the nearest, or null.
Answer Router::RefuseMoment(std::uint64_t wanted, const SceneState* nearest) const {
  const std::string number = "state " + std::to_string(wanted);
  if (nearest == nullptr) return Refuse(409, "no sample", "no sample has come yet");
  if (nearest->number == wanted) return Refuse(409, "no sample", number + " has no sample");
  if (nearest->number < wanted && site_.history->extent()->last_number < wanted) {
    return Refuse(409, "future moment",
                  number + " has not come yet; the newest one is " +
                      std::to_string(site_.history->extent()->last_number));
  }
  return Refuse(410, "moment is gone", number + " is no longer kept (--history_minutes)");
}

}  // namespace kinescope::http
