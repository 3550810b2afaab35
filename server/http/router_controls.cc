// The routes of controls: recordings, clips, people, limits, trials, files.
#include <string>
#include <utility>

#include "core/system/starts_with.h"
#include "server/http/control_orders.h"
#include "server/http/router.h"

namespace kinescope::http {
namespace {

constexpr char kNoControls[] = "this server has no controls";

}  // namespace

// `carry_out` receives the parsed order.
template <class Parse, class CarryOut>
Answer Router::Order(const Request& request, const char* what, Parse parse,
                     CarryOut carry_out) const {
  if (auto refusal = RefuseUnlessJson(request, what)) return *std::move(refusal);
  if (site_.controls == nullptr) return Refuse(503, "no controls", kNoControls);
  if (!request.body) return AskForBody();
  const auto order = parse(*request.body);
  if (!order) return Refuse(400, "bad order", order.error());
  const Controls::Result done = carry_out(*order);
  if (!done) return Refuse(done.error().status, "order refused", done.error().reason);
  return JsonAnswer(*done);
}

Answer Router::ControlStatus(const Request& /*request*/, Role /*role*/) const {
  if (site_.controls == nullptr) return Refuse(503, "no controls", kNoControls);
  return JsonAnswer(site_.controls->StatusJson());
}

Answer Router::Files(const Request& /*request*/, Role role) const {
  if (site_.controls == nullptr) return Refuse(503, "no controls", kNoControls);
  return JsonAnswer(site_.controls->FilesJson(role));
}

Answer Router::Record(const Request& request, Role role) const {
  return Order(request, "record", ParseRecordingOrder,
               [&](const RecordingOrder& order) { return site_.controls->Record(order, role); });
}

Answer Router::Clip(const Request& request, Role role) const {
  return Order(request, "make clips", ParseClipOrder,
               [&](const ClipOrder& order) { return site_.controls->Clip(order, role); });
}

Answer Router::SetPerson(const Request& request, Role role) const {
  return Order(request, "change people", ParsePersonOrder,
               [&](const PersonOrder& order) { return site_.controls->SetPerson(order, role); });
}

Answer Router::SetClassLimits(const Request& request, Role role) const {
  return Order(request, "change limits", ParseLimitsOrder,
               [&](const std::array<double, 2>& limits) {
                 return site_.controls->SetClassLimits(limits, role);
               });
}

Answer Router::RunTrial(const Request& request, Role role) const {
  return Order(request, "run trials", ParseTrialOrder,
               [&](const TrialOrder& order) { return site_.controls->RunTrial(order, role); });
}

Answer Router::Download(const Request& request, Role /*role*/) const {
  const std::string path = ParseTarget(request.target)->path;
  const std::string name = path.substr(path.rfind('/') + 1);
  const auto file = site_.controls != nullptr ? site_.controls->FindFile(name) : std::nullopt;
  if (!file) {
    return Refuse(404, "no such file", "the folder of recordings has no file of this name");
  }
  Answer answer;
  const std::string ending = file->extension().string();
  answer.content_type = ending == ".mp4"    ? "video/mp4"
                        : ending == ".png"  ? "image/png"
                        : ending == ".json" ? "application/json"
                                            : "application/octet-stream";
  // A report is HTML of its own: it is saved, and does not run as a page of this server.
  answer.headers.emplace_back("Content-Disposition", "attachment; filename=\"" + name + "\"");
  answer.headers.emplace_back("Cache-Control", "no-store");
  answer.file = *file;
  return answer;
}

}  // namespace kinescope::http
