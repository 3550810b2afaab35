// Where people have no folds the skin has none: on top of a shoulder whose arm is overhead, under
// the seat of a squatting person, and on the belly of a bent trunk.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "tests/urdf/skin_postures.h"

namespace kinescope::skin {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using urdf::At;

// The length of the edges at which the surface turns by more than so many degrees, m. `is_counted`
// says of a place in the bind pose whether its edges count.
template <class IsCounted>
double FoldedLength(const PersonSkin& skin, const PersonSkin::Surface& surface, double degrees,
                    const IsCounted& is_counted) {
  const auto cosine = static_cast<float>(std::cos(degrees * kDegree));
  const auto normal_of = [&](const Triangle& t) {
    const Vector3f& a = surface.positions[t[0]];
    return (surface.positions[t[1]] - a).cross(surface.positions[t[2]] - a).normalized().eval();
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
    if (normal.dot(normals.at({to, from})) < cosine) {
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
      const double folded = FoldedLength(skin, surface, 90, [&](const Vector3f& p) {
        return (p - joint).norm() < 0.16f && p.z() > joint.z() - 0.02f;
      });
      EXPECT_LT(folded, 0.01) << raised.name << (is_woman ? ", woman" : ", man") << ", m";
    }
  }
}

// The groin is a fold; seat and crotch are smooth.
TEST(SkinFolds, FewAreSharpWhereHipsBendFar) {
  struct Bent {
    const char* name;
    double out, hip, knee;  // degrees
  };
  for (const bool is_woman : {false, true}) {
    const double height = is_woman ? 1.62 : 1.75;
    const PersonSkin skin = SkinOf(is_woman, height, is_woman ? 62 : 75);
    for (const Bent& bent : {Bent{"sitting", 6, -90, 90}, {"squatting", 14, -118, 128}}) {
      urdf::JointAngles angles{};
      angles[urdf::jLeftHip] = kDegree * Vector3d(bent.out, bent.hip, 0);
      angles[urdf::jRightHip] = kDegree * Vector3d(-bent.out, bent.hip, 0);
      angles[urdf::jLeftKnee].y() = angles[urdf::jRightKnee].y() = bent.knee * kDegree;
      PersonSkin::Surface surface;
      skin.Pose(urdf::ForwardKinematics(urdf::DefaultSkeleton(height), {}, angles), {}, surface);
      const double folded = FoldedLength(skin, surface, 45, [](const Vector3f& p) {
        return (p - Vector3f(0, 0, -0.05f)).norm() < 0.25f && p.z() < -0.02f;
      });
      EXPECT_LT(folded, 1) << bent.name << (is_woman ? ", woman" : ", man") << ", m";
    }
  }
}

// The front of the belly beside the midline from the hips to the breastbone, every centimetre of
// the bind pose.
std::vector<Vector3d> ProfileOf(const PersonSkin& skin, const PersonSkin::Surface& surface) {
  constexpr int kPlaces = 28;
  std::vector<Vector3d> profile(kPlaces, Vector3d::Zero());
  std::vector<double> shares(kPlaces, 0);
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const Vector3f& p = skin.rest()[i];
    if (p.x() < 0.03f || std::abs(p.y()) > 0.06f) continue;
    for (int place = 0; place < kPlaces; ++place) {
      const double away = (p.z() - (0.04 + 0.01 * place)) / 0.008;
      const double share = std::exp(-away * away);
      profile[At(place)] += share * surface.positions[i].cast<double>();
      shares[At(place)] += share;
    }
  }
  for (int place = 0; place < kPlaces; ++place) profile[At(place)] /= shares[At(place)];
  return profile;
}

// How far the profile leaves its own mean over 8 cm at most, m.
double RippleOf(const std::vector<Vector3d>& profile) {
  constexpr std::size_t kReach = 3;
  std::vector<double> bulge;  // out of the chord between neighbours
  for (std::size_t i = kReach; i + kReach < profile.size(); ++i) {
    const Vector3d chord = profile[i + kReach] - profile[i - kReach];
    const Vector3d out = chord.cross(Vector3d::UnitY()).normalized();
    bulge.push_back(out.dot(profile[i] - 0.5 * (profile[i + kReach] + profile[i - kReach])));
  }
  double most = 0;
  for (std::size_t i = kReach; i + kReach < bulge.size(); ++i) {
    most = std::max(most, std::abs(bulge[i] - 0.5 * (bulge[i - kReach] + bulge[i + kReach])));
  }
  return most;
}

TEST(SkinFolds, ABentBellyHasNoRippleForEachJointOfTheSpine) {
  for (const bool is_woman : {false, true}) {
    const PersonSkin skin = SkinOf(is_woman, 1.75, is_woman ? 72.4 : 75);
    PersonSkin::Surface rest, bent;
    skin.Pose(skin.bind().links, {}, rest);
    urdf::LinkPoses links = skin.bind().links;
    for (const int joint : {urdf::jL5S1, urdf::jL4L3, urdf::jL1T12, urdf::jT9T8}) {
      links = TurnedAt(links, joint, Vector3d::UnitY(), 18);
    }
    skin.Pose(links, {}, bent);
    const double of_rest = RippleOf(ProfileOf(skin, rest)),
                 of_bent = RippleOf(ProfileOf(skin, bent));
    EXPECT_LT(of_bent, of_rest + 0.001) << (is_woman ? "woman" : "man") << ", m";
  }
}

}  // namespace
}  // namespace kinescope::skin
