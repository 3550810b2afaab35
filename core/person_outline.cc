#include "core/person_outline.h"

#include <algorithm>

#include "core/hand_load_shape.h"
#include "core/person_links.h"
#include "core/skin_inputs.h"
#include "urdf/skin/limbs.h"
#include "urdf/skin/occlusion.h"

namespace kinescope {
namespace {

using Eigen::Vector3d;

constexpr double kProp = 0.12;  // m: its shape is not known
// Of what sticks out of the capsules of a limb: nose, heel, thumb, clothes.
constexpr double kBeyondLimb = 0.02;  // m

}  // namespace

std::vector<Ball> BallsOf(const PersonState& person) {
  std::vector<Ball> balls;
  const urdf::Skeleton& skeleton = person.model->human.skeleton;
  const skin::Build build = BuildOf(*person.model);
  for (const skin::Capsule& limb : skin::CapsulesOf(skeleton, build, person.links)) {
    balls.push_back({limb.start.cast<double>(), limb.start_radius + kBeyondLimb});
    balls.push_back({limb.end.cast<double>(), limb.end_radius + kBeyondLimb});
  }
  for (const auto& prop : person.props) {
    if (prop) balls.push_back({prop->pose.position, kProp});
  }
  const HandLoadShape held = ShapeOfHandLoad(person);
  for (std::size_t i = 0; i < held.count; ++i) {
    const HandLoadSolid& solid = held.solids[i];
    const bool is_box = solid.kind == HandLoadSolid::Kind::kBox;
    const Vector3d half = (is_box ? 0.5 : 1) * solid.size;
    balls.push_back({solid.pose.position, std::max({half.x(), half.y(), 0.5 * solid.size.z()})});
  }
  return balls;
}

std::vector<OutlinePoint> OutlineOf(const PersonModel& model) {
  std::vector<OutlinePoint> outline;
  for (const auto& [start, end] : skin::LimbShapesOf(model.human.skeleton, BuildOf(model))) {
    for (const skin::LimbEnd& each : {start, end}) {
      outline.push_back(
          {static_cast<std::size_t>(each.segment), each.point, each.radius + kBeyondLimb});
    }
  }
  const std::size_t links = VisibleLinks(model.human).size(), props = model.human.props.count();
  for (std::size_t link = links - props; link < links; ++link) {
    outline.push_back({link, Vector3d::Zero(), kProp});
  }
  return outline;
}

}  // namespace kinescope
