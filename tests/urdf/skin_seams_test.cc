// The skin has no seams: what lies side by side in the bind pose does so in every picture of every
// posture. A picture of depth, normal and place in the bind pose tells a seam from an arm before
// the belly. The same surface cut into rigid parts shows that the test sees seams.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/urdf/skin_postures.h"

namespace kinescope::skin {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;
using Eigen::Vector3f;
using urdf::At;
using Positions = std::vector<Vector3f>;

// Of pixels, 2 m a side.
constexpr int kSide = 640;
constexpr float kPixel = 2.0f / kSide;  // m
// From the midline out, in the bind pose, m.
constexpr float kFingers = 0.58f;

struct Pixel {
  float depth = -std::numeric_limits<float>::infinity();  // towards the viewer, m
  Vector3f normal = Vector3f::Zero();                     // of the viewer
  Vector3f bind = Vector3f::Zero();                       // m

  bool is_body() const { return std::isfinite(depth); }
};

// Orthographic. `viewer_from_world`: x right, y up, z towards the viewer.
std::vector<Pixel> Draw(const PersonSkin& skin, const Positions& posed,
                        const Eigen::Matrix3f& viewer_from_world) {
  Vector3f low = posed[0], high = posed[0];
  for (const Vector3f& p : posed) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  std::vector<Vector3f> corners(posed.size()), normals(posed.size(), Vector3f::Zero());
  const Vector3f middle = 0.5f * (low + high);
  for (std::size_t i = 0; i < posed.size(); ++i) {
    const Vector3f p = viewer_from_world * (posed[i] - middle);
    corners[i] = {p.x() / kPixel + kSide / 2.0f, p.y() / kPixel + kSide / 2.0f, p.z()};
  }
  for (const Triangle& t : skin.triangles()) {
    const Vector3f normal = (posed[t[1]] - posed[t[0]]).cross(posed[t[2]] - posed[t[0]]);
    for (const std::uint16_t corner : t) normals[corner] += viewer_from_world * normal;
  }
  std::vector<Pixel> picture(std::size_t{kSide} * kSide);
  for (const Triangle& t : skin.triangles()) {
    const Vector3f &a = corners[t[0]], &b = corners[t[1]], &c = corners[t[2]];
    const Vector2f ab = (b - a).head<2>(), ac = (c - a).head<2>();
    const float area = ab.x() * ac.y() - ab.y() * ac.x();
    if (area <= 0) continue;  // seen from inside
    const Vector3f least = a.cwiseMin(b).cwiseMin(c), most = a.cwiseMax(b).cwiseMax(c);
    const auto first = [](float x) { return std::max(0, static_cast<int>(std::ceil(x - 0.5f))); };
    const auto last = [](float x) {
      return std::min(kSide - 1, static_cast<int>(std::floor(x - 0.5f)));
    };
    for (int y = first(least.y()); y <= last(most.y()); ++y) {
      for (int x = first(least.x()); x <= last(most.x()); ++x) {
        const Vector2f p(static_cast<float>(x) + 0.5f - a.x(),
                         static_cast<float>(y) + 0.5f - a.y());
        const float u = (p.x() * ac.y() - p.y() * ac.x()) / area;
        const float v = (ab.x() * p.y() - ab.y() * p.x()) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        const auto at = [&](const auto& of) {
          return ((1 - u - v) * of[t[0]] + u * of[t[1]] + v * of[t[2]]).eval();
        };
        Pixel& pixel = picture[At(y) * kSide + At(x)];
        const float depth = at(corners).z();
        if (depth <= pixel.depth) continue;
        pixel = {depth, at(normals).normalized(), at(skin.rest())};
      }
    }
  }
  return picture;
}

struct Seams {
  double steps = 0, creases = 0;  // per 1000 pixels of the body
};

// In five views.
Seams SeamsOf(const PersonSkin& skin, const Positions& posed) {
  const float crease = static_cast<float>(std::cos(35 * kDegree));
  int body = 0, steps = 0, creases = 0;
  for (const auto& [azimuth, elevation] :
       {std::pair(0, 0), {90, 0}, {180, 0}, {40, 15}, {220, 40}}) {
    const double turn = azimuth * kDegree, up = elevation * kDegree;
    const Vector3d to_viewer(std::cos(turn) * std::cos(up), std::sin(turn) * std::cos(up),
                             std::sin(up));
    const Vector3d right = Vector3d::UnitZ().cross(to_viewer).normalized();
    Eigen::Matrix3d axes;
    axes << right.transpose(), to_viewer.cross(right).transpose(), to_viewer.transpose();
    const std::vector<Pixel> picture = Draw(skin, posed, axes.cast<float>());
    for (std::size_t i = 0; i < picture.size(); ++i) {
      const Pixel& here = picture[i];
      if (!here.is_body()) continue;
      ++body;
      for (const std::size_t next : {i + 1, i + kSide}) {
        if (next >= picture.size() || !picture[next].is_body()) continue;
        const Pixel& there = picture[next];
        // Fingers are side by side in the bind pose, but in front of each other in many a view.
        const bool is_finger = std::abs(here.bind.y()) > kFingers;
        const bool are_neighbours = !is_finger && (here.bind - there.bind).norm() < 0.040f;
        if (!are_neighbours) continue;
        if (here.normal.dot(there.normal) < crease) ++creases;
        const bool face_viewer = std::min(here.normal.z(), there.normal.z()) > 0.4f;
        if (face_viewer && std::abs(here.depth - there.depth) > 0.008f) ++steps;
      }
    }
  }
  return {1000.0 * steps / body, 1000.0 * creases / body};
}

void SetBoth(urdf::JointAngles& angles, int right_joint, int left_joint, const Vector3d& degrees) {
  angles[At(right_joint)] = kDegree * degrees.cwiseProduct(Vector3d(-1, 1, -1));
  angles[At(left_joint)] = kDegree * degrees;
}

// Degrees, of the left side: x outwards, y back, z.
std::map<std::string, urdf::JointAngles> Postures() {
  std::map<std::string, urdf::JointAngles> postures;
  const auto shoulders = [](urdf::JointAngles& angles, const Vector3d& degrees) {
    SetBoth(angles, urdf::jRightShoulder, urdf::jLeftShoulder, degrees);
  };
  const auto hips = [](urdf::JointAngles& angles, const Vector3d& degrees) {
    SetBoth(angles, urdf::jRightHip, urdf::jLeftHip, degrees);
  };
  const auto knees = [](urdf::JointAngles& angles, double degrees) {
    SetBoth(angles, urdf::jRightKnee, urdf::jLeftKnee, {0, degrees, 0});
  };
  shoulders(postures["t_pose"], {90, 0, 0});
  shoulders(postures["arms up sideways"], {165, 0, 0});
  shoulders(postures["arms up forwards"], {10, -165, 0});
  urdf::JointAngles& folded = postures["elbows and a knee at 150 degrees"];
  shoulders(folded, {30, 0, 0});
  SetBoth(folded, urdf::jRightElbow, urdf::jLeftElbow, {0, -150, 0});
  folded[urdf::jRightHip].y() = -60 * kDegree;
  folded[urdf::jRightKnee].y() = 150 * kDegree;
  urdf::JointAngles& twisted = postures["trunk bent and twisted"];
  for (const int joint : {urdf::jL5S1, urdf::jL4L3, urdf::jL1T12, urdf::jT9T8}) {
    twisted[At(joint)] = kDegree * Vector3d(5, 18, 12);
  }
  shoulders(twisted, {20, -50, 0});
  urdf::JointAngles& sitting = postures["sitting"];
  hips(sitting, {8, -90, 0});
  knees(sitting, 90);
  shoulders(sitting, {5, -40, 0});
  urdf::JointAngles& squatting = postures["squatting"];
  hips(squatting, {15, -120, 0});
  knees(squatting, 140);
  shoulders(squatting, {5, -80, 0});
  urdf::JointAngles& kneeling = postures["kneeling"];
  kneeling[urdf::jRightKnee].y() = 100 * kDegree;
  kneeling[urdf::jLeftHip].y() = -90 * kDegree;
  kneeling[urdf::jLeftKnee].y() = 90 * kDegree;
  urdf::JointAngles& crawling = postures["crawling"];
  hips(crawling, {2, -90, 0});
  knees(crawling, 90);
  shoulders(crawling, {10, -90, 0});
  crawling[urdf::jC1Head].y() = -30 * kDegree;
  shoulders(postures["lying"], {15, 5, 0});
  urdf::JointAngles& walking = postures["walking"];
  walking[urdf::jRightHip].y() = -30 * kDegree;
  walking[urdf::jLeftHip].y() = 15 * kDegree;
  walking[urdf::jLeftKnee].y() = 40 * kDegree;
  walking[urdf::jRightShoulder].y() = 25 * kDegree;
  walking[urdf::jLeftShoulder].y() = -25 * kDegree;
  urdf::JointAngles& lifting = postures["lifting"];
  for (const int joint : {urdf::jL5S1, urdf::jL4L3, urdf::jL1T12, urdf::jT9T8}) {
    lifting[At(joint)].y() = 10 * kDegree;
  }
  hips(lifting, {8, -95, 0});
  knees(lifting, 95);
  shoulders(lifting, {5, -70, 0});
  return postures;
}

// How much more than the bind pose itself, whose lips and ears count, a posture may have. Both are
// also folds as people have them: the most steps are in the groins of a crawling woman (0.27), the
// creases in hollows of knees, too (1.42 of a sitting man).
constexpr double kMoreSteps = 0.30, kMoreCreases = 1.45;

urdf::LinkPoses Posed(const urdf::JointAngles& angles) {
  return urdf::ForwardKinematics(urdf::DefaultSkeleton(), {}, angles);
}

TEST(SkinSeams, NoneShowInAnyPosture) {
  for (const bool is_woman : {false, true}) {
    const PersonSkin skin = SkinOf(is_woman, 1.75, is_woman ? 72.4 : 75);
    const Seams bind = SeamsOf(skin, skin.rest());
    for (const auto& [name, angles] : Postures()) {
      PersonSkin::Surface surface;
      skin.Pose(Posed(angles), {}, surface);
      const Seams seams = SeamsOf(skin, surface.positions);
      EXPECT_LE(seams.steps, bind.steps + kMoreSteps) << name << (is_woman ? ", woman" : ", man");
      EXPECT_LE(seams.creases, bind.creases + kMoreCreases)
          << name << (is_woman ? ", woman" : ", man");
    }
  }
}

TEST(SkinSeams, ShowWhereTheBodyIsRigidParts) {
  const PersonSkin skin = SkinOf(false, 1.75, 75);
  const Seams bind = SeamsOf(skin, skin.rest());
  for (const auto& [name, angles] : Postures()) {
    const Seams seams = SeamsOf(skin, PosedAsRigidParts(skin, Posed(angles)));
    const bool has_steps = seams.steps > bind.steps + kMoreSteps;
    const bool has_creases = seams.creases > bind.creases + kMoreCreases;
    // Where arms rise forwards the parts turn about their own seam.
    EXPECT_TRUE(has_steps || (name == "arms up forwards" && has_creases))
        << name << ": " << seams.steps << " steps";
  }
}

}  // namespace
}  // namespace kinescope::skin
