#include "core/person_outline.h"

#include <algorithm>

#include "core/hand_load_shape.h"
#include "core/skin_inputs.h"
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

double HeightFor(const PersonState& person, double floor_z) {
  constexpr double kLeast = 0.9, kMost = 3.4;  // m
  // What comes towards the camera is larger in perspective.
  constexpr double kTowards = 0.3;  // of how far it comes
  const Eigen::Vector2d place = person.links[urdf::kPelvis].position.head<2>();
  double highest = 0, farthest = 0;
  for (const Ball& ball : BallsOf(person)) {
    const double side = (ball.center.head<2>() - place).norm() + ball.radius;
    highest = std::max(highest, ball.center.z() + ball.radius - floor_z);
    farthest = std::max(farthest, side);
  }
  const double needed = std::max(highest, 2 * farthest) + kTowards * farthest;
  return std::clamp(needed / kLiveFill, kLeast, kMost);
}

}  // namespace kinescope
