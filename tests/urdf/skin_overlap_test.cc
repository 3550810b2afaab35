// Where a joint bends far, flesh flattens: the skin passes through itself by little, and by less
// than the rigid parts that it replaces.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/urdf/skin_postures.h"

namespace kinescope::skin {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using urdf::At;

// Of a closed surface, in litres: of all that is inside at least twice, by lines along x.
double Overlap(const std::vector<Vector3f>& positions, const std::vector<Triangle>& triangles) {
  constexpr double kStep = 0.003, kReach = 1.3;  // m
  constexpr int kLines = static_cast<int>(2 * kReach / kStep);
  struct Crossing {
    double x;
    int enters;  // 1 or -1
    bool operator<(const Crossing& other) const { return x < other.x; }
  };
  std::vector<std::vector<Crossing>> lines(std::size_t{kLines} * kLines);
  // Beside the places of vertices, which symmetry puts on round numbers.
  const auto place = [&](int line) { return (line + 0.5) * kStep - kReach + 1.7e-6; };
  const auto first = [&](double least) {
    return std::max(0, static_cast<int>(std::ceil((least + kReach) / kStep - 0.51)));
  };
  const auto last = [&](double most) {
    return std::min(kLines - 1, static_cast<int>(std::floor((most + kReach) / kStep - 0.49)));
  };
  for (const Triangle& t : triangles) {
    const Vector3d a = positions[t[0]].cast<double>(), b = positions[t[1]].cast<double>(),
                   c = positions[t[2]].cast<double>();
    const Vector3d ab = b - a, ac = c - a, low = a.cwiseMin(b).cwiseMin(c),
                   high = a.cwiseMax(b).cwiseMax(c);
    const double area = ab.y() * ac.z() - ab.z() * ac.y();
    if (area == 0) continue;
    for (int j = first(low.z()); j <= last(high.z()); ++j) {
      for (int i = first(low.y()); i <= last(high.y()); ++i) {
        const double y = place(i) - a.y(), z = place(j) - a.z();
        const double u = (y * ac.z() - z * ac.y()) / area, v = (ab.y() * z - ab.z() * y) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        lines[At(j) * kLines + At(i)].push_back(
            {a.x() + u * ab.x() + v * ac.x(), area > 0 ? -1 : 1});
      }
    }
  }
  double length = 0;
  for (std::vector<Crossing>& line : lines) {
    std::sort(line.begin(), line.end());
    int inside = 0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      inside += line[i].enters;
      if (inside >= 2) length += line[i + 1].x - line[i].x;
    }
  }
  return 1000 * length * kStep * kStep;
}

struct Turn {
  int joint;
  Vector3d axis;  // of the child link
  double degrees;
};
struct FarPosture {
  const char* name;
  std::vector<Turn> turns;  // from the bind pose
  // Litres, of a man and a woman: a third of the overlap if the skin were only blended.
  double most_of_man = 9, most_of_woman = 9;
};

TEST(SkinOverlap, IsSmallAndLessThanThatOfRigidParts) {
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  const std::vector<FarPosture> postures = {
      {"elbow at 150 degrees", {{urdf::jLeftElbow, -y, 150}}, 0.104, 0.085},
      {"knee at 150 degrees", {{urdf::jLeftKnee, y, 150}}, 0.332, 0.381},
      {"hip at 120 degrees", {{urdf::jLeftHip, -y, 120}}, 0.137, 0.186},
      {"arm up", {{urdf::jLeftShoulder, x, 123}}},
      {"trunk bent and twisted",
       {{urdf::jL5S1, y, 20},
        {urdf::jL4L3, y, 20},
        {urdf::jL1T12, y, 20},
        {urdf::jL4L3, z, 15},
        {urdf::jL1T12, z, 15},
        {urdf::jT9T8, z, 15}}},
  };
  for (const bool is_woman : {false, true}) {
    const PersonSkin skin = SkinOf(is_woman, 1.75, is_woman ? 72.4 : 75);
    for (const FarPosture& posture : postures) {
      urdf::LinkPoses links = skin.bind().links;
      for (const Turn& turn : posture.turns) {
        links = TurnedAt(links, turn.joint, turn.axis, turn.degrees);
      }
      PersonSkin::Surface surface;
      skin.Pose(links, {}, surface);
      const double own = Overlap(surface.positions, skin.triangles());
      const double rigid = Overlap(PosedAsRigidParts(skin, links), skin.triangles());
      EXPECT_LT(own, is_woman ? posture.most_of_woman : posture.most_of_man)
          << posture.name << (is_woman ? ", woman" : ", man") << ", litres";
      EXPECT_LT(own, rigid) << posture.name << (is_woman ? ", woman" : ", man") << ", litres";
    }
  }
}

}  // namespace
}  // namespace kinescope::skin
