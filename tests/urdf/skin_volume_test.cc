// The skin of a bent joint is as voluminous as it was, and a raised arm as thick.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/urdf/skin_postures.h"

namespace kinescope::skin {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using urdf::At;

// Of the tissue within reach of a joint: how much more volume it has when bent.
// Where the surface overlaps itself, it counts twice.
double VolumeChange(const PersonSkin& skin, int joint, const Vector3d& axis, double degrees,
                    float reach = 0.16f) {
  const Vector3f center = skin.bind().links[At(urdf::ChildOf(joint))].position.cast<float>();
  double tissue = 0;
  for (const Triangle& t : skin.triangles()) {
    const Vector3f a = skin.rest()[t[0]] - center, b = skin.rest()[t[1]] - center,
                   c = skin.rest()[t[2]] - center;
    if (std::max({a.norm(), b.norm(), c.norm()}) < reach) tissue += a.dot(b.cross(c)) / 6;
  }
  PersonSkin::Surface rest, bent;
  skin.Pose(skin.bind().links, {}, rest);
  skin.Pose(TurnedAt(skin.bind().links, joint, axis, degrees), {}, bent);
  return (SignedVolume(bent.positions, skin.triangles()) -
          SignedVolume(rest.positions, skin.triangles())) /
         tissue;
}

TEST(SkinVolume, KeepsItsVolumeWhereAJointBends) {
  for (const bool is_woman : {false, true}) {
    const PersonSkin skin = SkinOf(is_woman, 1.75, is_woman ? 72.4 : 75);
    for (const double degrees : {60.0, 90.0, 105.0, 120.0, 135.0, 150.0}) {
      EXPECT_NEAR(VolumeChange(skin, urdf::jLeftElbow, {0, -1, 0}, degrees), 0, 0.10) << degrees;
      EXPECT_NEAR(VolumeChange(skin, urdf::jLeftKnee, {0, 1, 0}, degrees), 0, 0.10) << degrees;
      if (degrees > 120) continue;
      EXPECT_NEAR(VolumeChange(skin, urdf::jLeftHip, {0, -1, 0}, degrees), 0, 0.10) << degrees;
    }
    EXPECT_NEAR(VolumeChange(skin, urdf::jLeftWrist, {1, 0, 0}, 80), 0, 0.10);
    EXPECT_NEAR(VolumeChange(skin, urdf::jT9T8, {0, 1, 0}, 30), 0, 0.10);
    EXPECT_NEAR(VolumeChange(skin, urdf::jT9T8, {0, 0, 1}, 30), 0, 0.10);
  }
}

// The shoulder blade does not help, as that of a person would.
TEST(SkinVolume, KeepsItsVolumeWhereAnArmIsRaised) {
  constexpr double kBindDegrees = 42;
  for (const bool is_woman : {false, true}) {
    const PersonSkin skin = SkinOf(is_woman, 1.75, is_woman ? 72.4 : 75);
    for (const double degrees : {90.0, 120.0, 145.0, 165.0}) {
      EXPECT_NEAR(VolumeChange(skin, urdf::jLeftShoulder, {1, 0, 0}, degrees - kBindDegrees), 0,
                  0.10)
          << degrees;
    }
    EXPECT_NEAR(VolumeChange(skin, urdf::jLeftShoulder, {1, 0, 0}, 165 - kBindDegrees, 0.13f), 0,
                0.10)
        << "close to the joint";
  }
}

// A deltoid that lags behind its arm leaves a notch, and ends in a rim as of a rolled sleeve.
TEST(SkinVolume, KeepsARaisedArmAsThickAsItIs) {
  const PersonSkin skin = SkinOf(false, 1.75, 75);
  const urdf::LinkPoses raised = TurnedAt(skin.bind().links, urdf::jLeftShoulder, {1, 0, 0}, 123);
  PersonSkin::Surface surface;
  skin.Pose(raised, {}, surface);
  int seen = 0;
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const Vector3d rest =
        InLink(skin.bind().links[urdf::kLeftUpperArm], skin.rest()[i].cast<double>());
    const bool is_on_top = std::abs(rest.x()) < 0.006 && rest.y() > 0.02 && rest.norm() < 0.2;
    const Vector3d p = InLink(raised[urdf::kLeftUpperArm], surface.positions[i].cast<double>());
    if (!is_on_top || -p.z() < 0.07) continue;
    ++seen;
    EXPECT_GT(p.y(), 0.026) << -p.z() << " m along the arm";
  }
  EXPECT_GT(seen, 8);
}

}  // namespace
}  // namespace kinescope::skin
