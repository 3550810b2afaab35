#include "server/app/study/study_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/scene_state.h"
#include "core/system/utf8.h"
#include "core/system/words.h"
#include "server/app/shell_word.h"
#include "server/table/load_rows.h"

namespace kinescope::app {
namespace {

constexpr std::size_t kMostColumns = 6;

// Mean over the trials of a condition that know the joint, %; NaN: none does.
double MeanHigh(const Study& study, const std::string& condition, std::size_t joint) {
  double sum = 0;
  std::size_t count = 0;
  for (const StudyTrial& trial : study.trials) {
    if (!trial.loads || trial.condition != condition) continue;
    const JointLoads& loads = trial.loads->joints[joint];
    if (!loads.is_known()) continue;
    sum += loads.Percent(LoadClass::kHigh);
    ++count;
  }
  return sum / static_cast<double>(count);
}

std::string PercentText(double value) {
  return std::isfinite(value) ? fmt::format("{:.1f}", value) : "-";
}

std::string ChangeText(double change) {
  return std::isfinite(change) ? fmt::format("{:+.1f}", change) : "-";
}

std::string Shortened(const std::string& text) {
  constexpr std::size_t kMost = 12;
  return text.empty() ? "(none)" : PrintableLine(text).substr(0, kMost);
}

void AddTable(const Study& study, std::string& text) {
  std::vector<std::string> conditions = study.Conditions();
  const std::size_t all = conditions.size();
  conditions.resize(std::min(all, kMostColumns));
  const bool has_change = all == 2;
  text +=
      fmt::format("\nTime with high load, % of the trial, mean of the trials:\n{:<18}", "joint");
  for (const std::string& condition : conditions) {
    text += fmt::format("{:>14}", all == 1 && condition.empty() ? "all" : Shortened(condition));
  }
  text += has_change ? fmt::format("{:>10}\n", "change") : "\n";
  for (std::size_t joint = 0; joint < urdf::kScoredJointCount; ++joint) {
    text += fmt::format("{:<18}", ScoredLabel(joint));
    std::vector<double> means;
    for (const std::string& condition : conditions) {
      means.push_back(MeanHigh(study, condition, joint));
      text += fmt::format("{:>14}", PercentText(means.back()));
    }
    text += has_change ? fmt::format("{:>10}\n", ChangeText(means[1] - means[0])) : "\n";
  }
  if (all > kMostColumns) {
    text += fmt::format("and {} more, in --csv and --report\n",
                        Counted(all - kMostColumns, "condition"));
  }
}

void AddFailures(const Study& study, std::string& text) {
  std::map<std::string, std::vector<const StudyFailure*>> kinds;
  for (const StudyFailure& failure : study.failures) kinds[failure.kind].push_back(&failure);
  std::vector<std::pair<std::string, std::vector<const StudyFailure*>>> sorted(kinds.begin(),
                                                                               kinds.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second.size() > b.second.size(); });
  text += "\nNot complete:\n";
  for (const auto& [kind, failures] : sorted) {
    const StudyFailure& first = *failures.front();
    text += fmt::format(
        "{:>6}  {}: {}\n", failures.size(),
        failures.size() == 1 ? PrintableLine(first.id) : PrintableLine(first.id) + " and others",
        PrintableLine(first.reason));
  }
  text += "To do only these again: " + RetryCommandOf(study) + '\n';
}

}  // namespace

std::string HeadlineOf(const Study& study) {
  std::string text = Counted(study.trials.size(), "trial");
  const std::vector<std::string> people = study.People(), conditions = study.Conditions();
  const auto known = [](const std::vector<std::string>& names) {
    return names.size() - static_cast<std::size_t>(!names.empty() && names.front().empty());
  };
  if (known(people) > 0) text += " of " + Counted(known(people), "person", "people");
  if (known(conditions) > 0) text += " in " + Counted(known(conditions), "condition");
  text += fmt::format(": {} with loads", study.with_loads());
  std::map<std::string, std::size_t> states;
  for (const StudyFailure& failure : study.failures) ++states[failure.state];
  for (const auto& [state, count] : states) {
    text += fmt::format(", {} {}", Counted(count, "job"), state);
  }
  return text;
}

std::string RetryCommandOf(const Study& study) {
  return fmt::format("kinescope batch {} --retry failed",
                     study.list.empty() ? "LIST" : ShellWord(study.list));
}

std::vector<std::string> DifferencesOf(const Study& study) {
  std::vector<std::string> lines;
  for (const StudyDifference& each : study.differences) {
    std::string values;
    for (const auto& [value, count] : each.trials) {
      values +=
          fmt::format("{}{} ({})", values.empty() ? "" : ", ", value, Counted(count, "trial"));
    }
    lines.push_back(fmt::format("Trials differ in {}: {}", each.option, values));
  }
  return lines;
}

std::string TextOf(const Study& study) {
  std::string text = HeadlineOf(study) + '\n';
  if (study.with_loads() > 0) AddTable(study, text);
  for (const std::string& line : DifferencesOf(study)) text += '\n' + PrintableLine(line) + '\n';
  if (!study.failures.empty()) AddFailures(study, text);
  return text;
}

}  // namespace kinescope::app
