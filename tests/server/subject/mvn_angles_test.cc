#include "server/subject/mvn_angles.h"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/server/subject/subject_checks.h"
#include "tests/shared_data.h"

namespace kinescope::subject {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using testing::Index;

// The seed bridge's way from streamed angles to its joint states (mvn-protocol.md 6.1), in degrees:
// it turns about its published y, then x, then z.
Quaterniond AsSeedPublishes(int joint, const Vector3d& streamed) {
  const std::string name(urdf::kJoints[Index(joint)].ros_name);
  Vector3d sign(1, 1, 1);
  if (name.rfind("right_", 0) == 0) sign = {-1, 1, name == "right_knee" ? 1.0 : -1.0};
  if (name.rfind("left_", 0) == 0) sign = {1, -1, name == "left_knee" ? 1.0 : -1.0};
  Vector3d published(sign.x() * streamed.x(), sign.z() * streamed.z(), sign.y() * streamed.y());
  if (name == "right_elbow") published.z() -= 90;
  if (name == "left_elbow") published.z() += 90;
  return urdf::RotationFromAngles(published * M_PI / 180);
}

TEST(MvnAngles, AreConvertedToLinkRotationsByTheMappingOfXsensMvnRos) {
  for (const std::string& name : MotionNames()) {
    const auto motion = MakeMotion(name);
    for (double t = 0.05; t < 8; t += 0.31) {
      const BodySample sample = motion->At(t);
      const urdf::LinkPoses links = LinkPosesOf(sample);
      for (int joint = 0; joint < urdf::kJointCount; ++joint) {
        // The seed leaves wrists a quarter turn about the forearm away from its own frames.
        if (joint == urdf::jRightWrist || joint == urdf::jLeftWrist) continue;
        const Quaterniond actual = links[Index(urdf::ParentOf(joint))].orientation.conjugate() *
                                   links[Index(urdf::ChildOf(joint))].orientation;
        const Quaterniond published =
            AsSeedPublishes(joint, (*sample.streamed_angles_deg)[Index(joint)]);
        ASSERT_LT(actual.angularDistance(published), 1e-7)
            << urdf::kJoints[Index(joint)].mvn_name << " of " << name << " at " << t;
      }
    }
  }
}

TEST(MvnAngles, HaveTheClinicalMeaning) {
  urdf::LinkPoses links;
  const auto rest = StreamedAngles(links);
  for (const int elbow : {urdf::jRightElbow, urdf::jLeftElbow}) {
    EXPECT_NEAR((rest[Index(elbow)] - Vector3d(0, 90, 0)).norm(), 0, 1e-9) << "thumbs forward";
  }
  EXPECT_NEAR(rest[urdf::jRightKnee].norm(), 0, 1e-9);

  const auto turned = [](double degrees, const Vector3d& axis) {
    return urdf::Pose{Vector3d::Zero(), Quaterniond(AngleAxisd(degrees * M_PI / 180, axis))};
  };
  links[urdf::kRightForeArm] = links[urdf::kRightHand] = turned(-60, Vector3d::UnitY());
  links[urdf::kLeftUpperLeg] = turned(-50, Vector3d::UnitY());
  links[urdf::kRightLowerLeg] = turned(40, Vector3d::UnitY());
  links[urdf::kLeftUpperArm] = turned(30, Vector3d::UnitX());
  links[urdf::kRightHand] = turned(-80, Vector3d::UnitY());
  const auto bent = StreamedAngles(links);
  EXPECT_NEAR((bent[urdf::jRightElbow] - Vector3d(0, 90, 60)).norm(), 0, 1e-9);
  EXPECT_NEAR((bent[urdf::jLeftHip] - Vector3d(0, 0, 50)).norm(), 0, 1e-9) << "flexion";
  EXPECT_NEAR((bent[urdf::jRightKnee] - Vector3d(0, 0, 40)).norm(), 0, 1e-9) << "flexion";
  EXPECT_NEAR((bent[urdf::jLeftShoulder] - Vector3d(30, 0, 0)).norm(), 0, 1e-9) << "abduction";
  EXPECT_NEAR((bent[urdf::jRightWrist] - Vector3d(20, 0, 0)).norm(), 0, 1e-9) << "radial";
}

// The numbers of every <tag>...</tag> within a motion frame of the document.
std::vector<std::vector<double>> FramesOf(const std::string& document, const std::string& tag) {
  std::vector<std::vector<double>> frames;
  for (std::size_t at = document.find("type=\"normal\""); at != std::string::npos;
       at = document.find("type=\"normal\"", at + 1)) {
    const std::size_t begin = document.find("<" + tag + ">", at) + tag.size() + 2;
    std::istringstream numbers(document.substr(begin, document.find('<', begin) - begin));
    frames.emplace_back(std::istream_iterator<double>(numbers), std::istream_iterator<double>());
  }
  return frames;
}

TEST(MvnAngles, EqualThoseThatMvnStoredInARecording) {
  KINESCOPE_NEEDS_SHARED_DATA("mvnx/test_mocap.mvnx");
  const std::string document =
      kinescope::testing::ReadFile(kinescope::testing::SharedData("mvnx/test_mocap.mvnx"));
  const auto orientations = FramesOf(document, "orientation");
  const auto angles = FramesOf(document, "jointAngle");
  ASSERT_EQ(orientations.size(), 112u);
  ASSERT_EQ(angles.size(), 112u);
  for (std::size_t frame = 0; frame < angles.size(); ++frame) {
    ASSERT_EQ(orientations[frame].size(), 4u * urdf::kSegmentCount);
    ASSERT_EQ(angles[frame].size(), 3u * urdf::kJointCount);
    urdf::LinkPoses links;
    for (int i = 0; i < urdf::kSegmentCount; ++i) {
      const double* q = &orientations[frame][4 * Index(i)];
      links[Index(i)].orientation =
          Quaterniond(q[0], q[1], q[2], q[3]).normalized() * urdf::SegmentFromLink(i);
    }
    const auto computed = StreamedAngles(links);
    for (std::size_t joint = 0; joint < computed.size(); ++joint) {
      const double* stored = &angles[frame][3 * joint];
      ASSERT_NEAR((computed[joint] - Vector3d(stored[0], stored[1], stored[2])).norm(), 0, 0.005)
          << urdf::kJoints[joint].mvn_name << " in frame " << frame;
    }
  }
}

}  // namespace
}  // namespace kinescope::subject
