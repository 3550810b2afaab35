#include "server/app/urdf/urdf_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "core/system/json_text.h"
#include "core/system/words.h"

namespace kinescope::app {
namespace {

using urdf::UrdfProblem;
using urdf::UrdfReport;

constexpr int kMaxAlike = 3;

std::string VerdictText(const UrdfReport& report) {
  const auto count = [&](UrdfProblem::Kind kind) {
    return static_cast<std::size_t>(std::count_if(report.problems.begin(), report.problems.end(),
                                                  [&](const auto& p) { return p.kind == kind; }));
  };
  const std::size_t warnings = count(UrdfProblem::Kind::kWarning);
  const std::size_t errors = report.problems.size() - warnings;
  const std::string reported =
      warnings == 0 ? "" : (errors == 0 ? ", with " : " and ") + Counted(warnings, "warning");
  if (errors == 0) return "usable" + reported;
  const bool is_readable = count(UrdfProblem::Kind::kUnreadable) == 0;
  return (is_readable ? "can be drawn, but contains " : "not usable: ") + Counted(errors, "error") +
         reported;
}

std::string Roots(const UrdfReport& report) {
  if (report.roots.empty()) return "no root";
  if (report.roots.size() > 1) return Counted(report.roots.size(), "root");
  return "root '" + report.roots.front() + "'";
}

}  // namespace

std::string UrdfReportText(const std::string& file, const UrdfReport& report) {
  std::string text = fmt::format("{}: robot '{}', {}, {} links, {} joints, {:.3f} kg; {}, {}\n",
                                 file, report.robot, Roots(report), report.links, report.joints,
                                 report.mass, Counted(report.moving_joints, "moving joint"),
                                 Counted(report.meshes, "mesh file"));
  std::map<std::string, int> alike;
  for (const UrdfProblem& problem : report.problems) ++alike[problem.what];
  std::map<std::string, int> reported;
  for (const UrdfProblem& problem : report.problems) {
    const int number = ++reported[problem.what];
    const int all = alike[problem.what];
    if (number > kMaxAlike && all > kMaxAlike + 1) continue;
    const std::string place = problem.line > 0 ? fmt::format(":{}", problem.line) : "";
    text += fmt::format("{}{}: {}: {}: {}; {}\n", file, place, Name(problem.kind), problem.element,
                        problem.what, problem.suggestion);
    if (number == kMaxAlike && all > kMaxAlike + 1) {
      text += fmt::format("  … and {} more like this (--json lists them)\n", all - kMaxAlike);
    }
  }
  return text + fmt::format("{}: {}\n", file, VerdictText(report));
}

std::string UrdfReportJson(const std::string& file, const UrdfReport& report) {
  nlohmann::ordered_json problems = nlohmann::ordered_json::array();
  for (const UrdfProblem& problem : report.problems) {
    problems.push_back({{"kind", Name(problem.kind)},
                        {"line", problem.line},
                        {"element", problem.element},
                        {"what", problem.what},
                        {"suggestion", problem.suggestion}});
  }
  const nlohmann::ordered_json json = {
      {"file", file},
      {"usable", report.is_usable()},
      {"robot", report.robot},
      {"roots", report.roots},
      {"links", report.links},
      {"joints", report.joints},
      {"moving_joints", report.moving_joints},
      {"mesh_files", report.meshes},
      {"mass_kg", report.mass},
      {"problems", problems},
  };
  // Names come from outside and are cut at any byte.
  return JsonText(json) + "\n";
}

}  // namespace kinescope::app
