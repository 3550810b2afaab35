#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/system/errors.h"
#include "server/ros/bridge.h"
#include "server/ros/source/bag_source.h"
#include "server/ros/source/graph_source.h"

namespace kinescope::ros_bridge {
namespace {

using ::testing::HasSubstr;

TEST(WithoutRos, RemappingsAreRemovedFromTheArguments) {
  std::vector<std::string> words = {"kinescope",   "serve",        "__name:=xsens",
                                    "udp://:9763", "_udp_port:=1", "--tf=off"};
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  int argc = static_cast<int>(argv.size());
  TakeRosArguments(argc, argv.data(), "kinescope");
  ASSERT_EQ(argc, 4);
  EXPECT_STREQ(argv[0], "kinescope");
  EXPECT_STREQ(argv[1], "serve");
  EXPECT_STREQ(argv[2], "udp://:9763");
  EXPECT_STREQ(argv[3], "--tf=off");
}

TEST(WithoutRos, PublishingIsRejectedWithARemedy) {
  EXPECT_FALSE(BuiltWithRos());
  EXPECT_FALSE(MasterIsReachable());
  EXPECT_EQ(MasterUri(), "");
  EXPECT_TRUE(PrivateParameters().empty());
  EXPECT_EQ(MakeRosBridge({}, RosMode::kOff), nullptr);
  try {
    static_cast<void>(MakeRosBridge({}, RosMode::kAuto));
    FAIL() << "made a bridge without ROS";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("-DKINESCOPE_WITH_ROS=ON"));
  }
}

TEST(WithoutRos, ABagIsRejectedByNameWithARemedy) {
  try {
    (void)OpenBag("take.bag");
    FAIL() << "opened a bag without ROS";
  } catch (const SourceError& error) {
    EXPECT_THAT(error.what(), HasSubstr("bag 'take.bag'"));
    EXPECT_THAT(error.what(), HasSubstr("-DKINESCOPE_WITH_ROS=ON"));
  }
}

TEST(WithoutRos, ALiveGraphIsRejectedByNameWithARemedy) {
  EXPECT_TRUE(IsGraphUrl("ros:"));
  try {
    OpenGraph("ros:/tf");
    FAIL() << "listened without ROS";
  } catch (const SourceError& error) {
    EXPECT_THAT(error.what(), HasSubstr("source 'ros:/tf'"));
    EXPECT_THAT(error.what(), HasSubstr("-DKINESCOPE_WITH_ROS=ON"));
  }
}

}  // namespace
}  // namespace kinescope::ros_bridge
