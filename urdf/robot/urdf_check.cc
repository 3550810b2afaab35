#include "urdf/robot/urdf_check.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>

#include "urdf/robot/robot_model.h"
#include "urdf/robot/urdf_check_parts.h"

namespace kinescope::urdf {
namespace {

using Kind = UrdfProblem::Kind;

// What is no URDF at all; nothing further is looked at then.
std::optional<UrdfProblem> FindOtherFormat(const XmlOutline& xml) {
  const XmlElement& root = xml[0];
  for (const XmlElement& element : xml.elements) {
    if (element.tag.compare(0, 6, "xacro:") != 0) continue;
    return UrdfProblem{Kind::kUnreadable, element.line, "<" + element.tag + ">",
                       "this is a xacro file, not a URDF", "run: xacro FILE.xacro > FILE.urdf"};
  }
  if (root.tag == "robot") return std::nullopt;
  return UrdfProblem{
      Kind::kUnreadable, root.line, "<" + root.tag.substr(0, 40) + ">",
      root.tag == "sdf" ? "this is an SDF, not a URDF" : "a URDF begins with <robot>",
      root.tag == "sdf" ? "export it as URDF" : "choose a URDF file"};
}

// A material may be defined at the top or in any visual, and then be used by name.
void FindUndefinedMaterials(const XmlOutline& xml, UrdfReport& report) {
  std::set<std::string_view> defined;
  for (const XmlElement& element : xml.elements) {
    const std::string* name = element.Attribute("name");
    if (element.tag == "material" && name != nullptr && element.first_child >= 0) {
      defined.insert(*name);
    }
  }
  for (const XmlElement& element : xml.elements) {
    const std::string* name = element.Attribute("name");
    const bool is_used = element.tag == "material" && name != nullptr && element.parent >= 0 &&
                         xml[element.parent].tag == "visual";
    if (!is_used || defined.count(*name) != 0) continue;
    const int link = xml[element.parent].parent;
    const std::string* owner = xml[link].Attribute("name");
    report.problems.push_back({Kind::kWarning, element.line,
                               Called(xml[link].tag, owner != nullptr ? *owner : ""),
                               Called("material", *name) + " is not defined",
                               "give it a <color>; until then it is drawn in grey"});
  }
}

std::vector<NamedMesh> CheckElements(const XmlOutline& xml, UrdfReport& report) {
  std::vector<NamedMesh> meshes;
  const std::string* name = xml[0].Attribute("name");
  if (name != nullptr) report.robot = *name;
  if (report.robot.empty()) {
    report.problems.push_back(
        {Kind::kUnreadable, xml[0].line, "robot", "it has no name", "write <robot name=\"...\">"});
  }
  const std::vector<bool> moves = CheckTree(xml, report, report.problems);
  for (int at = xml[0].first_child; at >= 0; at = xml[at].next_sibling) {
    const std::string& tag = xml[at].tag;
    if (tag == "link") {
      report.mass +=
          CheckLink(xml, at, moves[static_cast<std::size_t>(at)], meshes, report.problems);
    } else if (tag == "joint") {
      CheckJoint(xml, at, report.problems);
    } else if (tag == "material") {
      const std::string* own = xml[at].Attribute("name");
      CheckMaterial(xml, at, Called("material", own != nullptr ? *own : ""), report.problems);
    }
  }
  FindUndefinedMaterials(xml, report);
  return meshes;
}

void FindMeshes(const std::vector<NamedMesh>& meshes, const MeshSearch& search,
                UrdfReport& report) {
  std::map<std::string, std::string> reason_of;  // "": it is there
  for (const NamedMesh& mesh : meshes) {
    const auto [known, is_new] = reason_of.emplace(mesh.uri, "");
    if (is_new) {
      const auto found = FindMesh(mesh.uri, search);
      if (const auto* missing = std::get_if<MeshNotFound>(&found)) known->second = missing->reason;
    }
    if (known->second.empty()) continue;
    report.problems.push_back({Kind::kWrong, mesh.line, mesh.element,
                               "mesh " + mesh.uri + " is missing: " + known->second,
                               "add the file; until then it is drawn as a labelled box"});
  }
  report.meshes = reason_of.size();
}

bool IsUnreadable(const UrdfProblem& problem) { return problem.kind == Kind::kUnreadable; }

std::string OneLine(const UrdfProblem& problem) {
  return problem.element + ": " + problem.what + "; " + problem.suggestion;
}

}  // namespace

const char* Name(Kind kind) {
  switch (kind) {
    case Kind::kUnreadable: return "unreadable";
    case Kind::kWrong: return "wrong";
    case Kind::kWarning: break;
  }
  return "warning";
}

bool UrdfReport::is_usable() const {
  return std::all_of(problems.begin(), problems.end(),
                     [](const UrdfProblem& each) { return each.kind == Kind::kWarning; });
}

UrdfReport CheckUrdf(const std::string& xml, const MeshSearch& meshes) {
  UrdfReport report;
  try {
    const XmlOutline outline = ReadOutline(xml);
    if (auto other = FindOtherFormat(outline)) {
      report.problems.push_back(std::move(*other));
      return report;
    }
    FindMeshes(CheckElements(outline, report), meshes, report);
    const auto& problems = report.problems;
    if (std::none_of(problems.begin(), problems.end(), IsUnreadable)) ParseUrdf(xml);
  } catch (const UrdfError& error) {
    const std::string place = "line " + std::to_string(error.line()) + ": ";
    std::string what = error.what();
    if (error.line() > 0) what.erase(0, place.size());
    report.problems.push_back({Kind::kUnreadable, error.line(), "document", what,
                               "correct it; urdfdom and ROS cannot read it either"});
  }
  std::stable_sort(report.problems.begin(), report.problems.end(),
                   [](const UrdfProblem& a, const UrdfProblem& b) { return a.line < b.line; });
  return report;
}

void RefuseUnreadable(const XmlOutline& xml) {
  if (const auto other = FindOtherFormat(xml)) throw UrdfError(OneLine(*other), other->line);
  UrdfReport report;
  CheckElements(xml, report);
  const auto first = std::find_if(report.problems.begin(), report.problems.end(), IsUnreadable);
  if (first != report.problems.end()) throw UrdfError(OneLine(*first), first->line);
}

}  // namespace kinescope::urdf
