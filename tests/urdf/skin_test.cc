// The skin: closed, fitted, posed, clothed.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/urdf/skin_postures.h"
#include "urdf/skin/frames.h"
#include "urdf/skin/load_regions.h"
#include "urdf/skin/occlusion.h"
#include "urdf/skin/outfit.h"
#include "urdf/skin/person_skin.h"

namespace kinescope::skin {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using urdf::At;

urdf::LinkPoses Posed(const urdf::Skeleton& skeleton, const urdf::JointAngles& angles) {
  return urdf::ForwardKinematics(skeleton, {}, angles);
}

TEST(PersonSkin, IsOneClosedSurface) {
  const SkinTemplate& skin = BuiltInSkin();
  std::map<std::pair<int, int>, int> edges;
  for (const Triangle& t : skin.triangles) {
    for (std::size_t side = 0; side < 3; ++side) ++edges[{t[side], t[(side + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  // Euler's formula for a body without holes.
  EXPECT_EQ(skin.size() + skin.triangles.size(), edges.size() / 2 + 2);
}

TEST(PersonSkin, FitsTheMeasuredLengths) {
  urdf::Skeleton skeleton = urdf::DefaultSkeleton(1.9);
  skeleton.origin_in_parent[urdf::kLeftForeArm].z() *= 1.2;
  skeleton.origin_in_parent[urdf::kRightLowerLeg].z() *= 0.8;
  const PersonSkin skin(BuiltInSkin(), {}, skeleton);
  const urdf::LinkPoses links = Posed(skeleton, {});
  PersonSkin::Surface surface;
  skin.Pose(links, {}, surface);
  const auto reach = [&](const Vector3d& from, const Vector3d& direction) {
    double farthest = 0;
    for (const Vector3f& p : surface.positions) {
      farthest = std::max(farthest, (p.cast<double>() - from).dot(direction));
    }
    return farthest;
  };
  const Vector3d& head = links[urdf::kHead].position;
  EXPECT_NEAR(reach(head, Vector3d::UnitZ()), skeleton.head_top_in_head.z(), 0.012);
  const urdf::Pose& left_foot = links[urdf::kLeftFoot];
  EXPECT_NEAR(reach(left_foot.position, -Vector3d::UnitZ()),
              -skeleton.heel_in_foot[urdf::kLeft].z(), 0.006);
}

TEST(PersonSkin, StaysFiniteForImpossibleSkeletons) {
  urdf::Skeleton flat = urdf::DefaultSkeleton();
  for (Vector3d& origin : flat.origin_in_parent) origin.setZero();
  urdf::Skeleton unknown = urdf::DefaultSkeleton();
  unknown.height = 0;
  for (const urdf::Skeleton& skeleton :
       {flat, unknown, urdf::DefaultSkeleton(0.5), urdf::DefaultSkeleton(2.5), urdf::Skeleton()}) {
    const PersonSkin skin(BuiltInSkin(), BuildOf(true, skeleton.height, 300), skeleton);
    PersonSkin::Surface surface;
    skin.Pose(Posed(skeleton, {}), {}, surface);
    for (const Vector3f& p : surface.positions) ASSERT_TRUE(p.allFinite());
    for (const Vector3f& normal : surface.normals) ASSERT_NEAR(normal.norm(), 1, 1e-3);
  }
}

TEST(PersonSkin, MovesWithThePersonAsAWhole) {
  const PersonSkin skin = SkinOf(true, 1.62, 62);
  urdf::LinkPoses links = skin.bind().links;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(2, Vector3d(1, 2, 3).normalized()));
  const Vector3d away(3, -2, 1);
  for (urdf::Pose& link : links) link = {turn * link.position + away, turn * link.orientation};
  PersonSkin::Surface surface;
  skin.Pose(links, {}, surface);
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const Vector3d expected = turn * skin.rest()[i].cast<double>() + away;
    ASSERT_LT((surface.positions[i].cast<double>() - expected).norm(), 1e-4);
    ASSERT_NEAR(surface.normals[i].norm(), 1, 1e-4);
  }
}

TEST(PersonSkin, ClosesTheHandOfAGlove) {
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  const urdf::HandSkeleton hand = urdf::DefaultHand(urdf::kLeft, 0.19);
  const PersonSkin skin(BuiltInSkin(), {}, skeleton, {nullptr, &hand});
  const urdf::LinkPoses links = Posed(skeleton, {});
  urdf::FingerAngles fist{};
  for (int finger = 1; finger < urdf::kFingersPerHand; ++finger) {
    if (urdf::PlaceInRay(finger) > 0) fist[At(finger)].x() = -1.3;
  }
  const urdf::FingerPoses fingers = urdf::CompleteHand(hand, links[urdf::kLeftHand], {}, {}, fist);
  PersonSkin::Surface open, closed;
  skin.Pose(links, {}, open);
  skin.Pose(links, {nullptr, &fingers}, closed);
  const auto length = [&](const PersonSkin::Surface& surface) {
    float longest = 0;
    for (std::size_t i = 0; i < surface.positions.size(); ++i) {
      if (LimbOf(BuiltInSkin().weights[i]) != kLeftHandLimb) continue;
      const Vector3f wrist = links[urdf::kLeftHand].position.cast<float>();
      longest = std::max(longest, (wrist - surface.positions[i]).z());
    }
    return longest;
  };
  EXPECT_GT(length(open), 0.17f);
  EXPECT_LT(length(closed), 0.13f);
}

TEST(SkinTemplate, ReadsWhatItWrites) {
  const std::string bytes = ToBytes(BuiltInSkin());
  const SkinTemplate again = FromBytes(bytes);
  EXPECT_EQ(ToBytes(again), bytes);
}

TEST(SkinTemplate, RejectsWhatIsNoSkin) {
  const std::string bytes = ToBytes(BuiltInSkin());
  EXPECT_THROW(FromBytes(""), std::runtime_error);
  EXPECT_THROW(FromBytes("Skim" + bytes.substr(4)), std::runtime_error);
  EXPECT_THROW(FromBytes(bytes.substr(0, 8)), std::runtime_error);
  EXPECT_THROW(FromBytes(bytes.substr(0, bytes.size() - 1)), std::runtime_error);
}

// As the two sides of a furrow do that grow through each other: a tear along the back. Where arm
// and trunk of the heaviest have grown together, a few of 1 cm are, in the depth of the armpit.
TEST(SkinTemplate, TurnsNoTrianglesOverForLightAndHeavyPeople) {
  constexpr int kInArmpits = 30;
  const SkinTemplate& skin = BuiltInSkin();
  const auto normal_of = [](const std::vector<Vector3f>& at, const Triangle& t) {
    return (at[t[1]] - at[t[0]]).cross(at[t[2]] - at[t[0]]).normalized().eval();
  };
  for (const double woman : {0.0, 1.0}) {
    const std::vector<Vector3f> average = skin.Blend({woman, 0});
    for (const double heavy : {-0.45, 1.0, 1.6}) {
      const std::vector<Vector3f> other = skin.Blend({woman, heavy});
      int turned = 0;
      for (const Triangle& t : skin.triangles) {
        turned += normal_of(average, t).dot(normal_of(other, t)) < 0 ? 1 : 0;
      }
      EXPECT_LE(turned, kInArmpits) << "woman: " << woman << ", heavy: " << heavy;
    }
  }
}

TEST(BuildOf, FollowsTheBodyMassIndex) {
  EXPECT_NEAR(BuildOf(false, 1.75, 75).heavy, 0, 1e-9);
  EXPECT_NEAR(BuildOf(false, 1.75, 105).heavy, 1, 1e-9);
  EXPECT_NEAR(BuildOf(true, 1.62, 62).heavy, 0, 1e-9);
  EXPECT_EQ(BuildOf(true, 1.62, 62).woman, 1);
  // What no longer looks like a person is drawn as the nearest that does.
  EXPECT_EQ(BuildOf(false, 1.75, 300).heavy, 1.6);
  EXPECT_EQ(BuildOf(false, 2.3, 20).heavy, -0.45);
  EXPECT_EQ(BuildOf(false, 0, 75).heavy, 0) << "unknown stature";
}

TEST(OpenSky, IsLessBetweenArmAndTrunkAndBetweenTheLegs) {
  const PersonSkin skin = SkinOf(false, 1.75, 75);
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  const urdf::LinkPoses links = Posed(skeleton, {});
  PersonSkin::Surface surface;
  skin.Pose(links, {}, surface);
  std::vector<float> open;
  SetOpenSky(surface.positions, surface.normals, LimbRunsOf(BuiltInSkin().weights),
             CapsulesOf(skeleton, {}, links), open);
  const auto nearest = [&](const Vector3d& place, const Vector3d& looks) {
    std::size_t best = 0;
    double least = 9;
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (surface.normals[i].cast<double>().dot(looks) < 0.7) continue;
      const double away = (surface.positions[i].cast<double>() - place).norm();
      if (away < least) best = i;
      least = std::min(least, away);
    }
    return open[best];
  };
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY();
  EXPECT_GT(nearest(links[urdf::kT8].position + 0.1 * x, x), 0.9f);          // chest
  EXPECT_LT(nearest(links[urdf::kLeftHand].position - 0.03 * y, -y), 0.8f);  // wrist, hip beside
  EXPECT_LT(nearest(links[urdf::kLeftLowerLeg].position - 0.05 * y, -y), 0.85f);
  EXPECT_GT(nearest(links[urdf::kHead].position + Vector3d(0, 0, 0.19), Vector3d::UnitZ()), 0.95f);
}

TEST(OpenSky, IsLessOnTheFloorNearTheFeet) {
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  const urdf::LinkPoses links = Posed(skeleton, {});
  const Vector3f foot = links[urdf::kLeftFoot].position.cast<float>();
  std::vector<float> open;
  SetOpenSky({foot + Vector3f(0.05f, 0, -0.08f), foot + Vector3f(2, 0, -0.08f)},
             CapsulesOf(skeleton, {}, links), open);
  EXPECT_LT(open[0], 0.6f);
  EXPECT_GT(open[1], 0.95f);
}

TEST(OutfitOf, HasTrousersBelowTheBeltAndBareHands) {
  const SkinTemplate& skin = BuiltInSkin();
  const std::vector<Borders> outfit = OutfitOf(skin, {});
  const BindPose bind = BindPoseOf(urdf::DefaultSkeleton());
  for (std::size_t i = 0; i < skin.size(); ++i) {
    const Vector3d p = skin.corners[0][i].cast<double>();
    const auto is_near = [&](int segment, double reach) {
      return (p - bind.links[At(segment)].position).norm() < reach;
    };
    if (is_near(urdf::kLeftLowerLeg, 0.2)) EXPECT_GT(outfit[i].trousers, 0) << p.transpose();
    if (is_near(urdf::kLeftForeArm, 0.2)) EXPECT_LT(outfit[i].trousers, 0) << p.transpose();
    if (is_near(urdf::kRightToe, 0.06)) EXPECT_GT(outfit[i].shoes, 0) << p.transpose();
    const bool is_hand = LimbOf(skin.weights[i]) == kLeftHandLimb && is_near(urdf::kLeftHand, 0.2);
    if (is_hand && !is_near(urdf::kLeftHand, 0.05)) EXPECT_GT(outfit[i].bare, 0) << p.transpose();
    if (is_near(urdf::kT12, 0.12)) EXPECT_LT(outfit[i].bare, 0) << p.transpose();
  }
}

// Where the border of a region is drawn between two vertices, their joint must be the same.
TEST(LoadRegions, KeepADistanceFromEachOther) {
  for (const bool is_woman : {false, true}) {
    const double height = is_woman ? 1.55 : 1.85;
    const PersonSkin skin = SkinOf(is_woman, height, is_woman ? 50 : 100);
    const std::vector<LoadRegion> regions =
        LoadRegionsOf(skin.rest(), BuiltInSkin().weights, skin.triangles(), skin.bind(), height);
    for (const Triangle& t : skin.triangles()) {
      if (regions[t[0]].joint == regions[t[1]].joint && regions[t[1]].joint == regions[t[2]].joint)
        continue;
      std::ostringstream where;
      for (const std::uint16_t corner : t) {
        where << urdf::kJoints[At(urdf::kScoredJoints[regions[corner].joint])].label << " "
              << regions[corner].inside << " at " << skin.rest()[corner].transpose() << "\n";
      }
      for (const std::uint16_t corner : t) EXPECT_LT(regions[corner].inside, 0) << where.str();
      if (HasFailure()) return;
    }
  }
}

// The top of the shoulders is nearly level: a band of the neck would run out on it in lobes.
TEST(LoadRegions, ShowTheNeckInACollar) {
  for (const bool is_woman : {false, true}) {
    const double height = is_woman ? 1.62 : 1.75;
    const PersonSkin skin = SkinOf(is_woman, height, is_woman ? 62 : 75);
    const std::vector<LoadRegion> regions =
        LoadRegionsOf(skin.rest(), BuiltInSkin().weights, skin.triangles(), skin.bind(), height);
    const auto neck = RegionOf(urdf::jT1C7);
    ASSERT_TRUE(neck);
    double farthest = 0;
    for (std::size_t i = 0; i < regions.size(); ++i) {
      if (regions[i].joint != *neck || regions[i].inside <= 0) continue;
      farthest = std::max(farthest, std::abs(skin.rest()[i].y()) * 1.0);
    }
    EXPECT_GT(farthest, 0.055) << "m to the side";
    EXPECT_LT(farthest, 0.100) << "m to the side";
  }
}

TEST(LoadRegions, CoverSkinAroundEveryJointFromAllSides) {
  const PersonSkin skin = SkinOf(false, 1.75, 75);
  const std::vector<LoadRegion> regions =
      LoadRegionsOf(skin.rest(), BuiltInSkin().weights, skin.triangles(), skin.bind(), 1.75);
  PersonSkin::Surface rest;
  skin.Pose(skin.bind().links, {}, rest);
  const double unknown = 1 - 0.57;  // from where the smallest class is drawn
  for (std::size_t joint = 0; joint < urdf::kScoredJointCount; ++joint) {
    bool is_seen_from_front = false, is_seen_from_back = false;
    for (std::size_t i = 0; i < regions.size(); ++i) {
      if (regions[i].joint != joint || regions[i].inside < unknown) continue;
      is_seen_from_front = is_seen_from_front || rest.normals[i].x() > 0.3;
      is_seen_from_back = is_seen_from_back || rest.normals[i].x() < -0.3;
    }
    EXPECT_TRUE(is_seen_from_front && is_seen_from_back)
        << urdf::kJoints[At(urdf::kScoredJoints[joint])].label;
  }
}

}  // namespace
}  // namespace kinescope::skin
