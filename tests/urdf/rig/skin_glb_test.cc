// The built-in skin written as a GLB, and read again as a rigged person of the user's.
#include "urdf/rig/skin_glb.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "urdf/rig/rig.h"
#include "urdf/rig/rigged_skin.h"

namespace kinescope::rig {
namespace {

using Eigen::Vector3f;
using skin::PersonSkin;
using skin::SkinTemplate;

std::string Written(const urdf::Skeleton& skeleton) {
  const SkinTemplate& built_in = skin::BuiltInSkin();
  return WriteSkinGlb(PersonSkin(built_in, {}, skeleton), built_in,
                      std::vector<SkinTemplate::Color>(built_in.triangles.size(), {184, 176, 166}));
}

// Of each vertex of `of`, the one of `among` that is nearest to it, and at most 4 mm away.
std::vector<std::size_t> Nearest(const std::vector<Vector3f>& of,
                                 const std::vector<Vector3f>& among) {
  std::multimap<float, std::size_t> by_height;
  for (std::size_t i = 0; i < among.size(); ++i) by_height.emplace(among[i].z(), i);
  constexpr float kWithin = 0.004f;
  std::vector<std::size_t> nearest;
  for (const Vector3f& p : of) {
    std::size_t best = 0;
    float least = kWithin;
    const auto end = by_height.upper_bound(p.z() + kWithin);
    for (auto i = by_height.lower_bound(p.z() - kWithin); i != end; ++i) {
      const float distance = (among[i->second] - p).norm();
      if (distance < least) {
        least = distance;
        best = i->second;
      }
    }
    EXPECT_LT(least, kWithin) << "a vertex is where none was";
    nearest.push_back(best);
  }
  return nearest;
}

// Largest distance in random postures of vertices that are one in the bind pose, m.
double FarthestInPostures(const PersonSkin& ours, const PersonSkin& read,
                          const urdf::Skeleton& skeleton) {
  const std::vector<std::size_t> same = Nearest(read.rest(), ours.rest());
  double most = 0;
  std::mt19937 random(3);
  for (int posture = 0; posture < 4; ++posture) {
    urdf::JointAngles angles{};
    for (Eigen::Vector3d& joint : angles) {
      for (double& angle : joint) angle = static_cast<double>(random()) / 4294967295.0 - 0.5;
    }
    const urdf::LinkPoses links = urdf::ForwardKinematics(skeleton, {}, angles);
    PersonSkin::Surface a, b;
    ours.Pose(links, {}, a);
    read.Pose(links, {}, b);
    for (std::size_t i = 0; i < same.size(); ++i) {
      most = std::max(most, static_cast<double>((a.positions[same[i]] - b.positions[i]).norm()));
    }
  }
  return most;
}

TEST(SkinGlb, IsTheSameSkinWhenReadAgain) {
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  const SkinTemplate read = SkinOf(ReadRig(Written(skeleton)));
  EXPECT_EQ(read.size(), skin::BuiltInSkin().size());
  EXPECT_EQ(read.triangles.size(), skin::BuiltInSkin().triangles.size());
  EXPECT_EQ(read.colors[0], (SkinTemplate::Color{184, 176, 166, 255}));
  const PersonSkin ours(skin::BuiltInSkin(), {}, skeleton), again(read, {}, skeleton);
  EXPECT_LT(FarthestInPostures(ours, again, skeleton), 0.0005);
}

TEST(SkinGlb, FitsItsOwnPersonAgain) {
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton(1.52);
  const SkinTemplate read = SkinOf(ReadRig(Written(skeleton)));
  const PersonSkin ours(skin::BuiltInSkin(), {}, skeleton), again(read, {}, skeleton);
  EXPECT_LT(FarthestInPostures(ours, again, skeleton), 0.002);
}

}  // namespace
}  // namespace kinescope::rig
