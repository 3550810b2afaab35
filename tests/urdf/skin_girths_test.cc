// The skin as a tape and a balance measure it.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>
#include <vector>

#include "tests/urdf/skin_postures.h"
#include "urdf/skin/occlusion.h"
#include "urdf/skin/person_skin.h"

namespace kinescope::skin {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using urdf::At;

bool IsArm(std::size_t vertex) {
  const Limb limb = LimbOf(BuiltInSkin().weights[vertex]);
  return limb >= kRightUpperArmLimb && limb <= kLeftHandLimb;
}

// The perimeter of the convex hull of a section in the bind pose, as a tape measures it: of the
// trunk or of a left limb.
double Girth(const PersonSkin& skin, int segment, double along, bool is_limb) {
  const urdf::Pose& link = skin.bind().links[At(segment)];
  const bool is_arm = segment >= urdf::kLeftUpperArm && segment <= urdf::kLeftForeArm;
  std::vector<Eigen::Vector2d> points;
  for (const Triangle& t : skin.triangles()) {
    for (std::size_t side = 0; side < 3; ++side) {
      const Vector3d a = InLink(link, skin.rest()[t[side]].cast<double>());
      const Vector3d b = InLink(link, skin.rest()[t[(side + 1) % 3]].cast<double>());
      if ((a.z() < along) == (b.z() < along)) continue;
      const Vector3d p = a + (along - a.z()) / (b.z() - a.z()) * (b - a);
      const bool is_own = is_limb ? (link.position + link.orientation * p).y() > 0.002 &&
                                        p.head<2>().norm() < (is_arm ? 0.09 : 0.15)
                                  : !IsArm(t[side]);
      if (is_own) points.emplace_back(p.x(), p.y());
    }
  }
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return std::make_pair(a.x(), a.y()) < std::make_pair(b.x(), b.y());
  });
  std::vector<Eigen::Vector2d> hull;
  for (int half = 0; half < 2; ++half) {
    const std::size_t first = hull.size();
    for (const auto& p : points) {
      const auto turns = [&] {
        const Eigen::Vector2d u = hull.back() - hull[hull.size() - 2], v = p - hull.back();
        return u.x() * v.y() - u.y() * v.x();
      };
      while (hull.size() >= first + 2 && turns() <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  double girth = 0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    girth += (hull[(i + 1) % hull.size()] - hull[i]).norm();
  }
  return girth;
}

// The largest or smallest between two heights in the link, m.
double Extreme(const PersonSkin& skin, int segment, double from, double to, bool is_largest) {
  const bool is_limb = segment != urdf::kPelvis;
  double extreme = is_largest ? 0 : 9;
  for (double at = from; at <= to; at += 0.01) {
    const double girth = Girth(skin, segment, at, is_limb);
    extreme = is_largest ? std::max(extreme, girth) : std::min(extreme, girth);
  }
  return extreme;
}

struct Expected {
  double at_reference, per_cm, per_kg;  // mm, mm/cm, mm/kg
};
struct Tape {
  const char* what;
  int segment;
  double from, to;  // for a stature of 1.75 m
  bool is_largest;
  // ANSUR II (own regression; 1.75 m and 75 kg, 1.62 m and 62 kg). Biceps and forearm are measured
  // flexed there, 6 and 4 % more than relaxed.
  Expected man, woman;
};
constexpr Tape kTapes[] = {
    {"chest", urdf::kPelvis, 0.29, 0.34, true, {995, -2.91, 6.23}, {908, -3.29, 7.27}},
    {"waist", urdf::kPelvis, 0.13, 0.22, false, {860, -4.36, 7.96}, {813, -4.72, 9.08}},
    {"seat", urdf::kPelvis, -0.05, 0.05, true, {964, -1.40, 5.35}, {983, -1.78, 6.86}},
    {"thigh", urdf::kLeftUpperLeg, -0.16, -0.12, true, {583, -1.8, 4.1}, {588, -1.9, 5.1}},
    {"calf", urdf::kLeftLowerLeg, -0.20, -0.08, true, {373, -0.7, 1.9}, {361, -0.5, 2.2}},
    {"ankle", urdf::kLeftLowerLeg, -0.41, -0.30, false, {222, 0.1, 0.7}, {211, 0.1, 0.8}},
    {"upper arm", urdf::kLeftUpperArm, -0.21, -0.15, true, {315, -1.13, 2.16}, {274, -1.32, 2.63}},
    {"forearm", urdf::kLeftForeArm, -0.12, -0.05, true, {284, -0.29, 1.25}, {246, -0.29, 1.44}},
    {"wrist", urdf::kLeftForeArm, -0.26, -0.20, false, {172, 0.3, 0.4}, {152, 0.3, 0.4}},
};

struct Person {
  bool is_woman;
  double height, mass;
};

void ExpectGirths(const Person& person, double most_litres) {
  const PersonSkin skin = SkinOf(person.is_woman, person.height, person.mass);
  for (const Tape& tape : kTapes) {
    const Expected& of = person.is_woman ? tape.woman : tape.man;
    const double taller_cm = 100 * (person.height - (person.is_woman ? 1.62 : 1.75));
    const double heavier = person.mass - (person.is_woman ? 62 : 75);
    const double expected = of.at_reference + of.per_cm * taller_cm + of.per_kg * heavier;
    const double size = person.height / 1.75;
    const double girth =
        1000 * Extreme(skin, tape.segment, size * tape.from, size * tape.to, tape.is_largest);
    EXPECT_NEAR(girth / expected, 1, 0.065)
        << tape.what << " of a " << (person.is_woman ? "woman" : "man") << " of " << person.height
        << " m and " << person.mass << " kg: " << girth << " mm, expected " << expected;
  }
  EXPECT_NEAR(1000 * SignedVolume(skin.rest(), skin.triangles()) / person.mass, 0.95, most_litres)
      << "litres a kg";
}

TEST(PersonSkin, HasTheGirthsOfTheirSexStatureAndMass) {
  for (const Person& person : {Person{false, 1.75, 62},
                               {false, 1.75, 75},
                               {false, 1.75, 105},
                               {true, 1.62, 62},
                               {true, 1.62, 85}}) {
    ExpectGirths(person, 0.04);
  }
}

// One in twenty is shorter or taller; their mass is that of the same body mass index. Their volume
// grows with the cube of the stature, their mass with the square.
TEST(PersonSkin, HasTheGirthsOfShortAndTallPeople) {
  for (const Person& person :
       {Person{false, 1.63, 65}, {false, 1.88, 86.5}, {true, 1.52, 54.5}, {true, 1.74, 71.5}}) {
    ExpectGirths(person, 0.07);
  }
}

}  // namespace
}  // namespace kinescope::skin
