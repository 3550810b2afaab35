#include "server/app/golden/golden_changes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "core/system/json_text.h"
#include "server/app/golden/golden_page.h"

namespace kinescope::app {
namespace {

std::string TextOf(const nlohmann::json& value) {
  return value.is_string() ? value.get<std::string>() : JsonText(value);
}
const std::string& TextOf(const std::string& value) { return value; }

// Names that one of them has alone, or with another value.
template <class Value>
std::vector<std::string> Differences(const std::map<std::string, Value>& then,
                                     const std::map<std::string, Value>& now) {
  std::set<std::string> names;
  for (const auto& [name, value] : then) names.insert(name);
  for (const auto& [name, value] : now) names.insert(name);
  std::vector<std::string> lines;
  for (const std::string& name : names) {
    const auto before = then.find(name), after = now.find(name);
    if (before == then.end()) {
      lines.push_back(fmt::format("{}: added, {}", name, TextOf(after->second)));
    } else if (after == now.end()) {
      lines.push_back(fmt::format("{}: removed, was {}", name, TextOf(before->second)));
    } else if (before->second != after->second) {
      lines.push_back(
          fmt::format("{}: was {}, is {}", name, TextOf(before->second), TextOf(after->second)));
    }
  }
  return lines;
}

std::vector<std::string> InputDifferences(const std::vector<InputFact>& then,
                                          const std::vector<InputFact>& now) {
  std::vector<std::string> lines;
  for (const InputFact& input : now) {
    if (std::find(then.begin(), then.end(), input) != then.end()) continue;
    const auto before = std::find_if(then.begin(), then.end(), [&](const InputFact& each) {
      return each.option == input.option && each.name == input.name;
    });
    lines.push_back(before != then.end()
                        ? fmt::format("{}: the content of {} has changed (SHA-256 was {:.12}…, is "
                                      "{:.12}…)",
                                      input.option, input.name, before->sha256, input.sha256)
                        : fmt::format("{}: {} was not read before", input.option, input.name));
  }
  for (const InputFact& input : then) {
    const bool is_there = std::any_of(now.begin(), now.end(), [&](const InputFact& each) {
      return each.option == input.option && each.name == input.name;
    });
    if (!is_there) lines.push_back(fmt::format("{}: {} is not read", input.option, input.name));
  }
  return lines;
}

}  // namespace

bool IsForeignPage(const AcceptedCase& of_case) {
  const auto page = of_case.options.find("page");
  return page != of_case.options.end() && !(page->second.is_string() && IsDashboard(page->second));
}

GoldenChanges ChangesBetween(const AcceptedCase& accepted, const AcceptedCase& now) {
  return {Differences(accepted.options, now.options), InputDifferences(accepted.inputs, now.inputs),
          Differences(accepted.environment, now.environment), IsForeignPage(now)};
}

std::string CauseOf(const GoldenChanges& changes) {
  if (!changes.options.empty()) return "case";
  if (!changes.inputs.empty()) return "recording";
  if (!changes.environment.empty()) return "environment";
  return changes.is_page ? "page" : "program";
}

std::string CauseText(const GoldenChanges& changes) {
  const std::string cause = CauseOf(changes);
  if (cause == "case") {
    return fmt::format("The case has changed ({}), so it says nothing about the program.",
                       fmt::join(changes.options, "; "));
  }
  if (cause == "recording") {
    return fmt::format(
        "What is drawn has changed ({}), so the case says nothing about the program.",
        fmt::join(changes.inputs, "; "));
  }
  if (cause == "environment") {
    return fmt::format("It was drawn in another environment ({}); the {} may have changed, too.",
                       fmt::join(changes.environment, "; "), changes.is_page ? "page" : "program");
  }
  if (cause == "page") {
    return "The page has changed: case, browser and the page's own file are those of the accepted "
           "picture, so it is what the page loads or computes.";
  }
  return "The program has changed it: case, inputs and environment are those of the accepted "
         "picture.";
}

}  // namespace kinescope::app
