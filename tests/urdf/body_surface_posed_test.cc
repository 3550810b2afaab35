// The smooth figure as one sees it: in postures that people take, from several sides, pixel by
// pixel.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "server/subject/subject.h"
#include "tests/urdf/example_bodies.h"
#include "tests/urdf/pixels.h"
#include "urdf/kinematics.h"

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;
using testing::Hit;
using testing::Pixel;
using testing::Pixels;

constexpr double kMetersPerPixel = 0.006;

// The deepest moment of a lift, and what is held still.
const std::vector<std::pair<std::string, double>> kPostures = {
    {"n_pose", 0}, {"t_pose", 0}, {"squat", 0}, {"overhead", 0}, {"sit", 0}, {"lift", 2}};

const std::vector<std::pair<std::string, Vector3d>> kViews = {
    {"front", {1, 0, 0.1}},        {"left", {0, 1, 0.1}},
    {"behind", {-0.9, -0.4, 0.3}}, {"three_quarter", {0.8, -0.6, 0.25}},
    {"above", {-0.1, 0, 1}},       {"below", {0.2, 0.1, -1}}};

class PosedFigure : public testing::BodyTest {
 protected:
  // The posture of the built-in subject, taken by this body.
  LinkPoses Take(const std::string& posture, double seconds) const {
    const auto motion = subject::MakeMotion(posture, skeleton_.height);
    const LinkPoses poses = LinkPosesOf(motion->At(seconds));
    return ForwardKinematics(skeleton_, poses[kPelvis], AnglesFromPoses(poses, JointAngles{}));
  }

  Pixels Look(const LinkPoses& poses, const Vector3d& to_eye) const {
    Eigen::AlignedBox3d box;
    for (const Pose& pose : poses) box.extend(pose.position);
    const double across = box.diagonal().norm() + 0.5 * skeleton_.height;
    const int side = static_cast<int>(std::ceil(across / kMetersPerPixel));
    const Vector3d up = std::abs(to_eye.z()) > 0.9 ? Vector3d::UnitX() : Vector3d::UnitZ();
    Pixels pixels(box.center(), to_eye, up, side, side, kMetersPerPixel);
    for (int i = 0; i < kSegmentCount; ++i) pixels.Draw(meshes_[At(i)], poses[At(i)], i);
    return pixels;
  }

  void ExpectNoInside(const Pixels& pixels) const;
  void ExpectNoHoleAlongBones(const LinkPoses& poses, const Pixels& pixels) const;
  void ExpectNoFights(const Pixels& pixels) const;
};
INSTANTIATE_TEST_SUITE_P(Bodies, PosedFigure, testing::kBodies, testing::NameOfBody);

void PosedFigure::ExpectNoInside(const Pixels& pixels) const {
  int drawn = 0;
  std::map<std::string_view, int> inside;
  for (int y = 0; y < pixels.height(); ++y) {
    for (int x = 0; x < pixels.width(); ++x) {
      const Hit& front = pixels.at(x, y).front;
      if (front.segment < 0) continue;
      ++drawn;
      if (front.is_back) ++inside[kSegments[At(front.segment)].mvn_name];
    }
  }
  EXPECT_GT(drawn, 1500) << "a person";
  for (const auto& [segment, count] : inside) {
    ADD_FAILURE() << count << " px of the inside of " << segment;
  }
}

// Nothing of the background may show along the bones, joints included.
void PosedFigure::ExpectNoHoleAlongBones(const LinkPoses& poses, const Pixels& pixels) const {
  for (int i = 0; i < kSegmentCount; ++i) {
    if (i == kRightHand || i == kLeftHand) continue;  // between two fingers
    if (i == kRightToe || i == kLeftToe) continue;    // along the sole
    const Pose& pose = poses[At(i)];
    const Vector3d end = EndOf(skeleton_, i);
    // As thick as the thinnest place of the body, the ball of the foot.
    const double radius = 0.012 * skeleton_.height / 1.75;
    const double last = i == kHead ? 0.9 : 1;  // its crown is on the surface
    for (double along = 0; along <= last; along += 0.1) {
      const Vector3d bone = pixels.Project(pose.position + pose.orientation * (along * end));
      for (int turn = 0; turn < 16; ++turn) {
        const double angle = 2 * M_PI * turn / 16;
        const int x = static_cast<int>(bone.x() + radius / kMetersPerPixel * std::cos(angle));
        const int y = static_cast<int>(bone.y() + radius / kMetersPerPixel * std::sin(angle));
        ASSERT_GE(pixels.at(x, y).front.segment, 0)
            << kSegments[At(i)].mvn_name << " at " << along << " of its length";
      }
    }
  }
}

// Where two segments lie on one another over an area, and not just cross, it is chance which one a
// picture shows. That is seen where they are shaded differently.
void PosedFigure::ExpectNoFights(const Pixels& pixels) const {
  // 0.1 mm is several steps of the depth buffer at the distance of a picture.
  constexpr double kNear = 1e-4;
  const float alike = static_cast<float>(std::cos(4 * M_PI / 180));
  const auto fights = [&](int x, int y) {
    const Pixel& pixel = pixels.at(x, y);
    return pixel.behind.segment >= 0 && !pixel.behind.is_back &&
           pixel.behind.depth - pixel.front.depth < kNear &&
           pixel.front.normal.dot(pixel.behind.normal) < alike;
  };
  for (int y = 1; y + 1 < pixels.height(); ++y) {
    for (int x = 1; x + 1 < pixels.width(); ++x) {
      if (!fights(x, y)) continue;
      int around = 0;
      for (int i = 0; i < 9; ++i) around += fights(x - 1 + i % 3, y - 1 + i / 3) ? 1 : 0;
      EXPECT_LT(around, 7) << kSegments[At(pixels.at(x, y).front.segment)].mvn_name << " and "
                           << kSegments[At(pixels.at(x, y).behind.segment)].mvn_name;
    }
  }
}

TEST_P(PosedFigure, IsInOnePieceFromAllSides) {
  for (const auto& [posture, seconds] : kPostures) {
    const LinkPoses poses = Take(posture, seconds);
    for (const auto& [view, to_eye] : kViews) {
      SCOPED_TRACE(posture + " from " + view);
      const Pixels pixels = Look(poses, to_eye);
      ExpectNoInside(pixels);
      ExpectNoHoleAlongBones(poses, pixels);
      ExpectNoFights(pixels);
    }
  }
}

}  // namespace
}  // namespace kinescope::urdf
