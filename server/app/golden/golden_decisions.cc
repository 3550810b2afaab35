#include "server/app/golden/golden_decisions.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/system/errors.h"
#include "core/system/json_parse.h"
#include "core/system/json_text.h"
#include "render/image/new_file.h"
#include "server/app/ordered_json.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kReviewSchema = 1;

fs::path ReviewFile(const fs::path& run) { return run / "review.json"; }

Decision KeptFrom(const std::string& name) {
  for (const Decision decision : {Decision::kRejected, Decision::kLater}) {
    if (name == Name(decision)) return decision;
  }
  throw std::runtime_error(fmt::format("decision '{}'; expected rejected or later", name));
}

}  // namespace

const char* Name(Decision decision) {
  switch (decision) {
    case Decision::kAccepted: return "accepted";
    case Decision::kRejected: return "rejected";
    case Decision::kLater: return "later";
    case Decision::kUndecided: break;
  }
  return "undecided";
}

Decision DecisionFor(const CaseVerdict& verdict, const KeptDecisions& kept) {
  const auto found = kept.find(verdict.name);
  const bool is_of_it = found != kept.end() && verdict.now &&
                        found->second.pixels == verdict.now->pixels_sha256 &&
                        found->second.accepted_pixels == verdict.accepted_pixels;
  return is_of_it ? found->second.decision : Decision::kUndecided;
}

void Keep(Decision decision, const CaseVerdict& verdict, KeptDecisions& kept) {
  kept[verdict.name] = {decision, verdict.now->pixels_sha256, verdict.accepted_pixels};
}

KeptDecisions ParseDecisions(const std::string& text) {
  const json document = ParseJsonOrThrow(text);
  if (document.at("schema") != kReviewSchema) {
    throw std::runtime_error(fmt::format("schema {}; this version reads {}",
                                         JsonText(document.at("schema")), kReviewSchema));
  }
  KeptDecisions kept;
  for (const json& line : document.at("decisions")) {
    kept[line.at("case").get<std::string>()] = {KeptFrom(line.at("decision")), line.at("pixels"),
                                                line.at("accepted_pixels")};
  }
  return kept;
}

KeptDecisions ReadDecisions(const fs::path& run) {
  const fs::path path = ReviewFile(run);
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return {};
  try {
    return ParseDecisions(ReadSmallFile(path));
  } catch (const std::exception& error) {
    throw UsageError(fmt::format("{}: {}; remove the file to review the run from the beginning",
                                 path.string(), error.what()));
  }
}

void WriteDecisions(const fs::path& run, const KeptDecisions& kept) {
  Json document = {{"schema", kReviewSchema}, {"decisions", Json::array()}};
  for (const auto& [name, each] : kept) {
    document["decisions"].push_back({{"case", name},
                                     {"decision", Name(each.decision)},
                                     {"pixels", each.pixels},
                                     {"accepted_pixels", each.accepted_pixels}});
  }
  render::WriteNewFile(ReviewFile(run), JsonText(document, 1) + "\n");
}

}  // namespace kinescope::app
