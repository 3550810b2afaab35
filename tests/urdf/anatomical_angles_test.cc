#include "urdf/anatomical_angles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "tests/shared_data.h"

namespace kinescope::urdf {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Table = std::vector<std::vector<double>>;

// Turns the *link* frame of a hanging limb: forward is x, left is y.
void Turn(int segment, double degrees, const Vector3d& axis, SegmentOrientations& all) {
  const Quaterniond link(AngleAxisd(degrees * M_PI / 180, axis));
  all[At(segment)] = link * SegmentFromLink(segment).conjugate();
}

SegmentOrientations NPose() {
  SegmentOrientations all;
  for (int i = 0; i < kSegmentCount; ++i) Turn(i, 0, Vector3d::UnitX(), all);
  return all;
}

TEST(AnatomicalAngles, HaveTheClinicalMeaning) {
  SegmentOrientations body = NPose();
  const auto rest = AnatomicalAngles(body, AngleSequence::kZxy);
  for (const int elbow : {jRightElbow, jLeftElbow}) {
    EXPECT_NEAR((rest[At(elbow)] - Vector3d(0, 90, 0)).norm(), 0, 1e-9) << "thumbs forward";
  }
  EXPECT_NEAR(rest[jRightKnee].norm(), 0, 1e-9);

  Turn(kRightForeArm, -60, Vector3d::UnitY(), body);
  Turn(kRightHand, -80, Vector3d::UnitY(), body);
  Turn(kLeftUpperLeg, -50, Vector3d::UnitY(), body);
  Turn(kRightLowerLeg, 40, Vector3d::UnitY(), body);
  Turn(kLeftUpperArm, 30, Vector3d::UnitX(), body);
  Turn(kRightToe, 15, Vector3d::UnitY(), body);
  const auto bent = AnatomicalAngles(body, AngleSequence::kZxy);
  EXPECT_NEAR((bent[jRightElbow] - Vector3d(0, 90, 60)).norm(), 0, 1e-9);
  EXPECT_NEAR((bent[jLeftHip] - Vector3d(0, 0, 50)).norm(), 0, 1e-9) << "flexion";
  EXPECT_NEAR((bent[jRightKnee] - Vector3d(0, 0, 40)).norm(), 0, 1e-9) << "flexion";
  EXPECT_NEAR((bent[jLeftShoulder] - Vector3d(30, 0, 0)).norm(), 0, 1e-9) << "abduction";
  EXPECT_NEAR((bent[jRightWrist] - Vector3d(20, 0, 0)).norm(), 0, 1e-9) << "radial";
  EXPECT_NEAR((bent[jRightBallFoot] - Vector3d(0, 0, 15)).norm(), 0, 1e-9) << "toes down";
  const auto ergonomic = ErgonomicAngles(body, AngleSequence::kZxy);
  const auto left_arm = static_cast<std::size_t>(ErgonomicAngle::kT8LeftUpperArm);
  EXPECT_NEAR((ergonomic[left_arm] - Vector3d(30, 0, 0)).norm(), 0, 1e-9) << "abduction";
}

TEST(AnatomicalAngles, OfAnArmStretchedSidewaysHaveNoTwist) {
  SegmentOrientations body = NPose();
  for (int i = kRightUpperArm; i <= kRightHand; ++i) Turn(i, -90, Vector3d::UnitX(), body);
  const auto angles = AnatomicalAngles(body, AngleSequence::kZxy);
  EXPECT_NEAR((angles[jRightShoulder] - Vector3d(90, 0, 0)).norm(), 0, 1e-6);
  Turn(kLeftUpperLeg, -90, Vector3d::UnitY(), body);
  const auto hips = AnatomicalAngles(body, AngleSequence::kXzy);
  EXPECT_NEAR((hips[jLeftHip] - Vector3d(0, 0, 90)).norm(), 0, 1e-6);
}

TEST(AnatomicalAngles, AreThoseOfTheRotationMadeOfThem) {
  for (int joint = 0; joint < kJointCount; ++joint) {
    for (const Vector3d& written :
         {Vector3d(0, 0, 0), Vector3d(20, -50, 110), Vector3d(-89, 170, -3)}) {
      SegmentOrientations body = NPose();
      const std::size_t child = At(ChildOf(joint));
      body[child] = body[At(ParentOf(joint))] * RotationOfJoint(joint, written);
      const Vector3d read = AnatomicalAngles(body, AngleSequence::kZxy)[At(joint)];
      EXPECT_NEAR((read - written).norm(), 0, 1e-9) << kJoints[At(joint)].ros_name;
    }
  }
}

// The numbers of every <tag>...</tag> within a motion frame of the document.
Table FramesOf(const std::string& document, const std::string& tag) {
  Table frames;
  for (std::size_t at = document.find("type=\"normal\""); at != std::string::npos;
       at = document.find("type=\"normal\"", at + 1)) {
    const std::size_t begin = document.find("<" + tag + ">", at) + tag.size() + 2;
    std::istringstream numbers(document.substr(begin, document.find('<', begin) - begin));
    frames.emplace_back(std::istream_iterator<double>(numbers), std::istream_iterator<double>());
  }
  return frames;
}

TEST(AnatomicalAngles, EqualThoseThatMvnStoredInARecording) {
  KINESCOPE_NEEDS_SHARED_DATA("mvnx/test_mocap.mvnx");
  const std::string document =
      kinescope::testing::ReadFile(kinescope::testing::SharedData("mvnx/test_mocap.mvnx"));
  const Table orientations = FramesOf(document, "orientation");
  ASSERT_EQ(orientations.size(), 112u);
  struct Stored {
    const char* tag;
    Table rows;
    double tolerance;  // deg: six decimals of the quaternions, more where an angle is near its pole
  } stored[] = {
      {"jointAngle", {}, 0.005}, {"jointAngleXZY", {}, 0.005}, {"jointAngleErgo", {}, 0.005}};
  for (Stored& list : stored) {
    list.rows = FramesOf(document, list.tag);
    ASSERT_EQ(list.rows.size(), 112u) << list.tag;
  }
  const auto expect_near = [](const auto& computed, std::size_t count, const Stored& list,
                              std::size_t frame) {
    for (std::size_t i = 0; i < count; ++i) {
      const double* at = &list.rows[frame][3 * i];
      ASSERT_NEAR((computed[i] - Vector3d(at[0], at[1], at[2])).norm(), 0, list.tolerance)
          << list.tag << " " << i << " in frame " << frame;
    }
  };
  for (std::size_t frame = 0; frame < 112; ++frame) {
    SegmentOrientations body;
    for (std::size_t i = 0; i < kSegmentCount; ++i) {
      const double* q = &orientations[frame][4 * i];
      body[i] = Quaterniond(q[0], q[1], q[2], q[3]).normalized();
    }
    expect_near(AnatomicalAngles(body, AngleSequence::kZxy), kJointCount, stored[0], frame);
    expect_near(AnatomicalAngles(body, AngleSequence::kXzy), kJointCount, stored[1], frame);
    expect_near(ErgonomicAngles(body, AngleSequence::kZxy), stored[2].rows[frame].size() / 3,
                stored[2], frame);
  }
}

// The rows of a CSV after its header, without their first column.
Table RowsOf(const std::string& file) {
  std::istringstream lines(kinescope::testing::ReadFile(kinescope::testing::SharedData(file)));
  Table rows;
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::string cell;
    std::vector<double>& row = rows.emplace_back();
    std::getline(cells, cell, ',');
    while (std::getline(cells, cell, ',')) row.push_back(std::stod(cell));
  }
  return rows;
}

TEST(AnatomicalAngles, EqualThoseOfMvnToTheLastDigitsOfADouble) {
  KINESCOPE_NEEDS_SHARED_DATA("excel-export-P005/segment_orientation_quat.csv");
  const std::string folder = "excel-export-P005/";
  const Table orientations = RowsOf(folder + "segment_orientation_quat.csv");
  ASSERT_EQ(orientations.size(), 103u);
  const auto expect_near = [&](const char* file, const auto& angles_of) {
    const Table stored = RowsOf(folder + file);
    ASSERT_EQ(stored.size(), orientations.size());
    for (std::size_t frame = 0; frame < stored.size(); ++frame) {
      SegmentOrientations body;
      for (std::size_t i = 0; i < kSegmentCount; ++i) {
        const double* q = &orientations[frame][4 * i];
        body[i] = Quaterniond(q[0], q[1], q[2], q[3]);
      }
      const auto computed = angles_of(body);
      ASSERT_EQ(stored[frame].size(), 3 * computed.size());
      for (std::size_t i = 0; i < computed.size(); ++i) {
        const double* at = &stored[frame][3 * i];
        ASSERT_NEAR((computed[i] - Vector3d(at[0], at[1], at[2])).norm(), 0, 1e-10)
            << file << " " << i << " in frame " << frame;
      }
    }
  };
  const auto joints = [](AngleSequence sequence) {
    return [sequence](const SegmentOrientations& body) { return AnatomicalAngles(body, sequence); };
  };
  const auto ergonomic = [](AngleSequence sequence) {
    return [sequence](const SegmentOrientations& body) { return ErgonomicAngles(body, sequence); };
  };
  expect_near("joint_angles_zxy.csv", joints(AngleSequence::kZxy));
  expect_near("joint_angles_xzy.csv", joints(AngleSequence::kXzy));
  expect_near("ergonomic_joint_angles_zxy.csv", ergonomic(AngleSequence::kZxy));
  expect_near("ergonomic_joint_angles_xzy.csv", ergonomic(AngleSequence::kXzy));
}

}  // namespace
}  // namespace kinescope::urdf
