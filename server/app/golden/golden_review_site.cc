#include "server/app/golden/golden_review_site.h"

#include <fmt/format.h>

#include <array>
#include <exception>
#include <nlohmann/json.hpp>

#include "core/system/json_parse.h"
#include "core/system/json_text.h"
#include "core/system/words.h"
#include "server/app/golden/golden_report.h"
#include "server/app/ordered_json.h"
#include "server/http/access.h"

namespace kinescope::app {
namespace {

using http::Answer;
using http::ErrorAnswer;

struct ReviewOrder {
  const char* name;
  void (GoldenReview::*carry_out)(const CaseVerdict&);
};

constexpr std::array<ReviewOrder, 4> kReviewOrders = {{{"accept", &GoldenReview::Accept},
                                                       {"reject", &GoldenReview::Reject},
                                                       {"later", &GoldenReview::Postpone},
                                                       {"undo", &GoldenReview::Undo}}};

ReportSettings PageSettings(const GoldenReview& review, const std::string& token,
                            const std::string& nonce) {
  ReportSettings settings;
  settings.folder = review.folder();
  settings.pictures = review.pictures();
  settings.out = review.run_folder();
  settings.version = review.run().version;
  settings.review = ReviewedPage{token, nonce};
  return settings;
}

}  // namespace

ReviewSite::ReviewSite(GoldenReview& review, const std::string& token)
    : review_(review),
      nonce_(http::RandomToken()),
      page_(GoldenReport(review.run().verdicts, PageSettings(review, token, nonce_))) {}

Answer ReviewSite::Handle(const http::LocalRequest& request) {
  if (request.path == "/decisions") {
    if (request.is_post) return CarryOut(request.body);
    review_.Refresh();
    return Decisions();
  }
  if (request.path == "/" && !request.is_post) return Page();
  if (request.path == "/end" && request.is_post) return End();
  return ErrorAnswer(404, "unknown address; expected GET /, GET or POST /decisions or POST /end");
}

Answer ReviewSite::Page() const {
  Answer answer;
  answer.content_type = "text/html; charset=utf-8";
  answer.body = page_;
  answer.headers.emplace_back("Cache-Control", "no-store");
  answer.headers.emplace_back(
      "Content-Security-Policy",
      fmt::format("default-src 'none'; img-src data:; style-src 'nonce-{0}'; script-src "
                  "'nonce-{0}'; connect-src 'self'; base-uri 'none'; form-action 'none'; "
                  "frame-ancestors 'none'",
                  nonce_));
  return answer;
}

Answer ReviewSite::CarryOut(const std::string& body) {
  const auto order = ParseJson(body);
  if (!order.is_object() || !order.value("case", nlohmann::json()).is_string() ||
      !order.value("order", nlohmann::json()).is_string()) {
    return ErrorAnswer(400, "expected {\"case\": NAME, \"order\": accept, reject, later or undo}");
  }
  const std::string name = order["case"], wanted = order["order"];
  const CaseVerdict* const verdict = review_.Find(name);
  if (verdict == nullptr) {
    return ErrorAnswer(404, fmt::format("the run has no case '{}' to decide about", name));
  }
  for (const ReviewOrder& known : kReviewOrders) {
    if (wanted != known.name) continue;
    try {
      (review_.*known.carry_out)(*verdict);
      return Decisions();
    } catch (const std::exception& error) {
      return Decisions(409, error.what());
    }
  }
  return ErrorAnswer(400,
                     fmt::format("order '{}'; expected accept, reject, later or undo", wanted));
}

Answer ReviewSite::End() {
  const std::size_t left = review_.Count(Decision::kUndecided);
  if (left > 0) {
    return Decisions(409, fmt::format("{} undecided; decide about them, or end the command with "
                                      "Ctrl-C",
                                      Counted(left, "case is", "cases are")));
  }
  has_ended_ = true;
  return Decisions();
}

Answer ReviewSite::Decisions(int status, const std::string& error) const {
  Json document = {{"decisions", Json::object()}};
  for (const CaseVerdict* each : review_.cases()) {
    const Decision decision = review_.Of(*each);
    if (decision != Decision::kUndecided) document["decisions"][each->name] = Name(decision);
  }
  if (!error.empty()) document["error"] = error;
  Answer answer = http::JsonAnswer(JsonText(document));
  answer.status = status;
  return answer;
}

}  // namespace kinescope::app
