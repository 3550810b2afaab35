// Any text as a URDF: an UrdfError with a reason, or a robot that can be drawn; and a report that
// agrees with that.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>

#include "core/system/check.h"
#include "urdf/robot/robot_kinematics.h"
#include "urdf/robot/robot_model.h"
#include "urdf/robot/urdf_check.h"

namespace urdf_fuzz {
namespace {

using namespace kinescope::urdf;

void CheckGeometry(const Geometry& geometry) {
  KINESCOPE_CHECK(geometry.size.allFinite());
  KINESCOPE_CHECK(geometry.size.cwiseAbs().maxCoeff() <= kMaxScale);
}

void CheckTree(const RobotModel& robot) {
  std::set<std::string> links, reached = {robot.root_link};
  for (const Link& link : robot.links) links.insert(link.name);
  KINESCOPE_CHECK(links.size() == robot.links.size() && robot.links.size() <= kMaxLinks);
  KINESCOPE_CHECK(robot.links.front().name == robot.root_link);
  for (const RobotJoint& joint : robot.joints) {
    KINESCOPE_CHECK(reached.count(joint.parent_link) == 1);  // parents come before children
    reached.insert(joint.child_link);
  }
  KINESCOPE_CHECK(reached == links);
}

void CheckDrawable(const RobotModel& robot) {
  for (const Link& link : robot.links) {
    for (const Visual& visual : link.visuals) {
      KINESCOPE_CHECK(visual.link_from_visual.matrix().allFinite());
      CheckGeometry(visual.geometry);
    }
    for (const Collision& collision : link.collisions) {
      KINESCOPE_CHECK(collision.link_from_collision.matrix().allFinite());
      CheckGeometry(collision.geometry);
    }
    KINESCOPE_CHECK(!link.inertial || link.inertial->inertia.allFinite());
  }
  const auto placed = PlaceLinks(robot);
  KINESCOPE_CHECK(placed.size() == robot.links.size());
  for (const auto& link : placed) KINESCOPE_CHECK(link.matrix().allFinite());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string xml(reinterpret_cast<const char*>(data), size);
  bool is_read = false;
  try {
    const RobotModel robot = ParseUrdf(xml);
    is_read = true;
    CheckTree(robot);
    CheckDrawable(robot);
  } catch (const UrdfError& error) {
    KINESCOPE_CHECK(error.what()[0] != '\0');
  }
  // Meshes are not looked for: what a fuzzer makes up must not be opened.
  bool has_unreadable = false;
  const UrdfReport report = CheckUrdf(xml, MeshSearch());
  for (const UrdfProblem& problem : report.problems) {
    KINESCOPE_CHECK(!problem.element.empty() && !problem.what.empty() &&
                    !problem.suggestion.empty());
    has_unreadable = has_unreadable || problem.kind == UrdfProblem::Kind::kUnreadable;
  }
  KINESCOPE_CHECK(is_read == !has_unreadable);
  return 0;
}

}  // namespace urdf_fuzz
