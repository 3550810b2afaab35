// Where people have no folds the skin has none: on top of a shoulder whose arm is overhead.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <utility>

#include "tests/urdf/skin_postures.h"

namespace kinescope::skin {
namespace {

using Eigen::Vector3f;
using urdf::At;

// The length of the edges at which the surface turns by more than a right angle, m. `is_counted`
// says of a place in the bind pose whether its edges count.
template <class IsCounted>
double FoldedLength(const PersonSkin& skin, const PersonSkin::Surface& surface,
                    const IsCounted& is_counted) {
  const auto normal_of = [&](const Triangle& t) {
    const Vector3f& a = surface.positions[t[0]];
    return (surface.positions[t[1]] - a).cross(surface.positions[t[2]] - a).eval();
  };
  std::map<std::pair<int, int>, Vector3f> normals;
  for (const Triangle& t : skin.triangles()) {
    for (std::size_t side = 0; side < 3; ++side) {
      normals[{t[side], t[(side + 1) % 3]}] = normal_of(t);
    }
  }
  double length = 0;
  for (const auto& [edge, normal] : normals) {
    const auto [from, to] = edge;
    if (from > to || !is_counted(skin.rest()[At(from)])) continue;
    if (normal.dot(normals.at({to, from})) < 0) {
      length += (surface.positions[At(from)] - surface.positions[At(to)]).norm();
    }
  }
  return length;
}

TEST(SkinFolds, NoneAreSharpOnTheShoulderOfARaisedArm) {
  struct Raised {
    const char* name;
    double shoulder, arm;  // degrees
  };
  for (const bool is_woman : {false, true}) {
    const double height = is_woman ? 1.62 : 1.75;
    const PersonSkin skin = SkinOf(is_woman, height, is_woman ? 62 : 75);
    for (const Raised& raised : {Raised{"arms to the side", 0, 90}, {"arms overhead", 22, 143}}) {
      urdf::JointAngles angles{};
      angles[urdf::jLeftC7Shoulder].x() = raised.shoulder * kDegree;
      angles[urdf::jLeftShoulder].x() = raised.arm * kDegree;
      PersonSkin::Surface surface;
      skin.Pose(urdf::ForwardKinematics(urdf::DefaultSkeleton(height), {}, angles), {}, surface);
      const Vector3f joint = skin.bind().links[urdf::kLeftUpperArm].position.cast<float>();
      const double folded = FoldedLength(skin, surface, [&](const Vector3f& p) {
        return (p - joint).norm() < 0.16f && p.z() > joint.z() - 0.02f;
      });
      EXPECT_LT(folded, 0.01) << raised.name << (is_woman ? ", woman" : ", man") << ", m";
    }
  }
}

}  // namespace
}  // namespace kinescope::skin
