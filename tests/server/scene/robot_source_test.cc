// A URDF file as a robot that stands somewhere.
#include "server/scene/robot_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/system/errors.h"
#include "tests/temp_folder.h"
#include "urdf/robot/xml_outline.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::TempFolder;

constexpr char kTwoLinkArm[] =
    "<robot name='arm'><link name='base'/><link name='hand'/>"
    "<joint name='elbow' type='revolute'><parent link='base'/><child link='hand'/>"
    "<origin xyz='0 0 0.3'/><axis xyz='1 0 0'/>"
    "<limit lower='-2' upper='2' effort='1' velocity='1'/></joint></robot>";

class RobotSource : public ::testing::Test {
 protected:
  std::filesystem::path Write(const std::string& text) const {
    std::ofstream(folder_ / "robot.urdf", std::ios::binary) << text;
    return folder_ / "robot.urdf";
  }
  TempFolder folder_;
};

template <class Action>
std::string RobotSourceError(Action&& action) {
  try {
    action();
  } catch (const SourceError& error) {
    return error.what();
  }
  return "";
}

TEST_F(RobotSource, PutsEveryLinkInPlaceWithTheRootAtTheOrigin) {
  const RobotState robot = ReadRobot(Write(kTwoLinkArm), {});
  EXPECT_EQ(robot.name, "arm");
  ASSERT_TRUE(robot.model);
  ASSERT_TRUE(robot.meshes);
  ASSERT_EQ(robot.world_from_link.size(), 2U);
  EXPECT_EQ(robot.world_from_link[0].translation(), Vector3d::Zero());
  EXPECT_NEAR((robot.world_from_link[1].translation() - Vector3d(0, 0, 0.3)).norm(), 0, 1e-12);
  EXPECT_TRUE(robot.bounds.isEmpty()) << "who draws it knows them";
}

TEST_F(RobotSource, RotatesItsJoints) {
  const RobotState robot = ReadRobot(Write(kTwoLinkArm), {}, {{"elbow", M_PI_2}});
  const Vector3d y_of_hand = robot.world_from_link[1].linear() * Vector3d::UnitY();
  EXPECT_NEAR((y_of_hand - Vector3d::UnitZ()).norm(), 0, 1e-12);
}

TEST_F(RobotSource, NamesTheFileAndTheReason) {
  EXPECT_THAT(RobotSourceError([] { ReadUrdfFile("/nowhere.urdf"); }),
              AllOf(HasSubstr("/nowhere.urdf"), HasSubstr("No such file or directory")));
  EXPECT_THAT(RobotSourceError([&] { ReadUrdfFile(folder_.path()); }),
              AllOf(HasSubstr(folder_.path().string()), HasSubstr("is a folder")));
  const auto path = Write("<robot name='arm'>\n<link name='base'>\n</robot>");
  EXPECT_THAT(RobotSourceError([&] { ReadRobot(path, {}); }),
              AllOf(HasSubstr(path.string()), HasSubstr("line 3")));
}

TEST_F(RobotSource, NamesAnUnknownJoint) {
  const auto path = Write(kTwoLinkArm);
  EXPECT_THAT(RobotSourceError([&] {
                ReadRobot(path, {}, {{"knee", 1}});
              }),
              AllOf(HasSubstr(path.string()), HasSubstr("knee")));
}

// What is too long is read one byte further than any reader takes, so that it is refused as that.
TEST_F(RobotSource, ReadsFilesUpToTheLimitOfTheirReaders) {
  const std::size_t most = urdf::XmlLimits().bytes;
  EXPECT_EQ(ReadUrdfFile(Write("<robot/>")), "<robot/>");
  const auto path = Write("");
  std::filesystem::resize_file(path, 2 * most);  // a hole, no bytes on the disk
  EXPECT_EQ(ReadUrdfFile(path).size(), most + 1);
}

TEST_F(RobotSource, PutsTheRobotOnTheFloorAtTheGivenPlace) {
  RobotState robot = ReadRobot(Write(kTwoLinkArm), {});
  robot.bounds = Eigen::AlignedBox3d(Vector3d(-1, 0, -0.5), Vector3d(3, 2, 1.5));
  const std::vector<Eigen::Isometry3d> before = robot.world_from_link;
  StandOnFloor(robot, 10, -20);
  EXPECT_NEAR((robot.bounds.center() - Vector3d(10, -20, 1)).norm(), 0, 1e-12);
  EXPECT_NEAR(robot.bounds.min().z(), 0, 1e-12);
  const Vector3d shift(9, -21, 0.5);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_NEAR((robot.world_from_link[i].translation() - before[i].translation() - shift).norm(),
                0, 1e-12);
    EXPECT_EQ(robot.world_from_link[i].linear(), before[i].linear());
  }
}

}  // namespace
}  // namespace kinescope::app
