#include "server/app/study/study_page.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "core/compression_limits.h"
#include "core/scene_state.h"
#include "core/system/json_text.h"
#include "server/app/html.h"
#include "server/app/ordered_json.h"
#include "server/app/study/study_page_files.h"
#include "server/app/study/study_text.h"
#include "server/table/load_rows.h"
#include "server/table/output_file.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

constexpr LoadClass kBands[] = {LoadClass::kLow, LoadClass::kMedium, LoadClass::kHigh,
                                LoadClass::kUnknown};

// Whole numbers make a page of 5,000 trials half as large.
Json Scaled(double value, double scale) {
  return std::isfinite(value) ? Json(std::llround(value * scale)) : Json(nullptr);
}

// As a link: relative to the page.
std::string LinkTo(const std::string& path, const fs::path& folder) {
  const std::string relative = fs::path(path).lexically_relative(folder).generic_string();
  return PercentEncoded(relative.empty() ? path : relative);
}

// By joint: low, medium, high, unknown (0.01 %), p10, p50, p90, peak (0.001), time of the peak,
// longest time above the upper limit (0.01 s), how often above it.
Json JointsJson(const PersonLoads& person) {
  Json joints = Json::array();
  for (const JointLoads& joint : person.joints) {
    Json row = Json::array();
    for (const LoadClass band : kBands) row.push_back(Scaled(joint.Percent(band), 100));
    for (const double ratio : {joint.p10, joint.p50, joint.p90, joint.peak}) {
      row.push_back(Scaled(ratio, 1000));
    }
    row.push_back(Scaled(joint.peak_secs, 100));
    row.push_back(Scaled(joint.longest_high_secs, 100));
    row.push_back(joint.rises);
    joints.push_back(std::move(row));
  }
  return joints;
}

Json TrialJson(const StudyTrial& trial, const fs::path& folder) {
  Json out = {{"id", trial.id},
              {"person", trial.person},
              {"condition", trial.condition},
              {"state", trial.state}};
  if (!trial.labels.empty()) out["labels"] = trial.labels;
  if (!trial.source.empty()) out["source"] = trial.source;
  Json files = Json::array();
  for (const StudyFile& file : trial.files) {
    files.push_back({file.what, LinkTo(file.path, folder)});
  }
  if (!files.empty()) out["files"] = files;
  if (!trial.loads) {
    out["reason"] = trial.reason;
    return out;
  }
  const PersonLoads& person = *trial.loads;
  if (!person.sex.empty()) out["sex"] = person.sex;
  if (!person.hand_load.empty()) out["hands"] = person.hand_load;
  out["mass"] = person.mass_kg;
  out["secs"] = Scaled(person.secs, 100);
  out["samples"] = person.samples;
  out["spine"] = {Scaled(person.compression_most_N, 1), Scaled(person.compression_above_secs, 100)};
  out["joints"] = JointsJson(person);
  return out;
}

Json FailureJson(const StudyFailure& failure) {
  return {{"id", failure.id},
          {"command", failure.command},
          {"state", failure.state},
          {"reason", failure.reason},
          {"kind", failure.kind}};
}

// The limits that all trials have; null: they differ.
Json LimitsOf(const Study& study) {
  std::string limits;
  for (const StudyTrial& trial : study.trials) {
    const auto found = trial.options.find("class_limits");
    if (!trial.loads || found == trial.options.end()) continue;
    if (!limits.empty() && limits != found->second) return nullptr;
    limits = found->second;
  }
  const std::size_t comma = limits.find(',');
  if (comma == std::string::npos) return nullptr;
  return {std::stod(limits.substr(0, comma)), std::stod(limits.substr(comma + 1))};
}

std::string FootOf(const Study& study) {
  std::string versions;
  for (const auto& [program, trials] : study.programs) {
    versions += (versions.empty() ? "" : ", ") + program;
  }
  return fmt::format(
      "{} · shares are of all samples, by the ratio of each sample · a mean is that of the trials "
      "shown in which the load is known",
      versions.empty() ? "no loads" : versions);
}

Json StudyJson(const Study& study, const fs::path& folder) {
  Json joints = Json::array(), trials = Json::array(), failures = Json::array();
  for (std::size_t i = 0; i < urdf::kScoredJointCount; ++i) joints.push_back(ScoredLabel(i));
  for (const StudyTrial& trial : study.trials) trials.push_back(TrialJson(trial, folder));
  for (const StudyFailure& each : study.failures) failures.push_back(FailureJson(each));
  return {{"joints", joints},
          {"people", study.People()},
          {"conditions", study.Conditions()},
          {"limits", LimitsOf(study)},
          {"compression_N", kCompressionLimits[0]},
          {"retry", RetryCommandOf(study)},
          {"trials", trials},
          {"failures", failures}};
}

// In a script element: no text can end it.
std::string InScript(const Json& json) {
  std::string text;
  for (const char c : JsonText(json)) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text;
}

// For readers without scripts, and for print: mean time with high load by person and condition.
class PlainTable {
 public:
  explicit PlainTable(const Study& study) {
    for (const StudyTrial& trial : study.trials) {
      if (trial.loads) Add(trial);
    }
  }

  std::string Html() const {
    std::string html =
        "<table><caption>Time with high load, % of the trial, mean of the trials</caption>"
        "<thead><tr><th>person</th><th>condition</th><th>trials</th>";
    for (std::size_t i = 0; i < urdf::kScoredJointCount; ++i) {
      html += fmt::format("<th>{}</th>", EscapeHtml(ScoredLabel(i)));
    }
    html += "</tr></thead><tbody>\n";
    for (const auto& [group, cells] : groups_) {
      html += fmt::format("<tr><th>{}</th><td>{}</td><td>{}</td>", EscapeHtml(group.first),
                          EscapeHtml(group.second), cells.trials);
      for (const auto& [sum, count] : cells.joints) {
        html += count == 0 ? "<td>–</td>" : fmt::format("<td>{:.1f}</td>", sum / count);
      }
      html += "</tr>\n";
    }
    return html + "</tbody></table>\n";
  }

 private:
  struct Cells {
    int trials = 0;
    std::vector<std::pair<double, int>> joints =
        std::vector<std::pair<double, int>>(urdf::kScoredJointCount);
  };

  void Add(const StudyTrial& trial) {
    Cells& cells = groups_[{trial.person, trial.condition}];
    ++cells.trials;
    for (std::size_t i = 0; i < cells.joints.size(); ++i) {
      const JointLoads& joint = trial.loads->joints[i];
      if (!joint.is_known()) continue;
      cells.joints[i].first += joint.Percent(LoadClass::kHigh);
      ++cells.joints[i].second;
    }
  }

  std::map<std::pair<std::string, std::string>, Cells> groups_;  // by person and condition
};

}  // namespace

void WriteStudyPage(const Study& study, const std::string& title, const std::string& csv,
                    const std::string& path) {
  const fs::path folder = fs::absolute(path).lexically_normal().parent_path();
  std::string differences;
  for (const std::string& line : DifferencesOf(study)) {
    differences += fmt::format("<p class=\"warn\">{}</p>", EscapeHtml(line));
  }
  const std::string link =
      csv.empty() || csv == "-"
          ? ""
          : fmt::format("<a href=\"{}\" download>{}</a>",
                        EscapeHtml(LinkTo(fs::absolute(csv).lexically_normal().string(), folder)),
                        EscapeHtml(fs::path(csv).filename().string()));
  OutputFile out(path);
  out.buffer() += fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'; script-src 'unsafe-inline'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
      "<title>{0}</title>\n<style>{1}</style></head>\n<body>\n"
      "<header class=\"top\"><h1>{0}</h1><p>{2}</p>{3}</header>\n",
      EscapeHtml(title), kStudyStyle, EscapeHtml(HeadlineOf(study)), differences);
  out.buffer() += fmt::format("<div id=\"study\" data-csv=\"{}\"></div>\n<noscript>{}</noscript>\n",
                              EscapeHtml(link), PlainTable(study).Html());
  out.buffer() += fmt::format("<footer>{}</footer>\n", EscapeHtml(FootOf(study)));
  out.buffer() += "<script type=\"application/json\" id=\"data\">";
  out.buffer() += InScript(StudyJson(study, folder));
  out.buffer() +=
      fmt::format("</script>\n<script type=\"module\">{}</script>\n</body></html>\n", kStudyScript);
  out.Finish();
}

}  // namespace kinescope::app
