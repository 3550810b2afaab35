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

ViewRoom RoomFor(const PersonState& person, double floor_z) {
  constexpr double kLeast = 0.9, kMost = 3.4;  // m
  // How much lower and higher than at the target something seems to be that is 1 m nearer or
  // farther: named cameras look down by 6 to 14 degrees, and what is near is larger.
  constexpr double kLower = 0.4, kHigher = 0.1;
  constexpr double kNarrowest = 4.0 / 3, kWidthFill = 0.85;  // of a picture
  const Eigen::Vector2d place = person.links[urdf::kPelvis].position.head<2>();
  double above = 0, below = 0, farthest = 0;
  for (const Ball& ball : BallsOf(person)) {
    const double away = (ball.center.head<2>() - place).norm();
    const double z = ball.center.z() - floor_z;
    above = std::max(above, z + ball.radius + kHigher * away);
    below = std::max(below, kLower * away - (z - ball.radius));
    farthest = std::max(farthest, away + ball.radius);
  }
  const double height =
      std::max((above + below) / kLiveFill, 2 * farthest / kNarrowest / kWidthFill);
  return {std::clamp(height, kLeast, kMost), std::min(below, kMost)};
}

}  // namespace kinescope
