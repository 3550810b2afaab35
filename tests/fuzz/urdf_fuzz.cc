// Any text as a URDF: an UrdfError with a reason, or a robot that can be drawn.
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>

#include "server/core/check.h"
#include "urdf/robot_model.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinescope::urdf;
  try {
    const RobotModel robot = ParseUrdf({reinterpret_cast<const char*>(data), size});
    std::set<std::string> links;
    for (const Link& link : robot.links) {
      links.insert(link.name);
      for (const Visual& visual : link.visuals) {
        KINESCOPE_CHECK(visual.link_from_visual.matrix().allFinite());
        KINESCOPE_CHECK(visual.geometry.size.allFinite());
      }
    }
    KINESCOPE_CHECK(links.count(robot.root_link) == 1);
    std::set<std::string> reached = {robot.root_link};
    for (const RobotJoint& joint : robot.joints) {
      KINESCOPE_CHECK(reached.count(joint.parent_link) == 1);  // parents come before children
      reached.insert(joint.child_link);
    }
    KINESCOPE_CHECK(reached == links);
  } catch (const UrdfError& error) {
    KINESCOPE_CHECK(error.what()[0] != '\0');
  }
  return 0;
}
