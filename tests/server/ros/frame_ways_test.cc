#include "server/ros/frame_ways.h"

#include <gmock/gmock.h>

#include <memory>
#include <utility>
#include <vector>

namespace kinescope::ros_bridge {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

using Frames = std::unordered_map<std::string, TreeFrame>;

Frames Hanging(const std::vector<TreeFrame>& all) {
  Frames frames;
  for (const TreeFrame& frame : all) frames[frame.name] = frame;
  return frames;
}

TEST(RootOf, IsThatOfTheLargestTree) {
  EXPECT_EQ(RootOf({}, ""), "");
  const Frames frames = Hanging({{"b_root", "", 0},
                                 {"b_1", "b_root", 0},
                                 {"a_root", "", 0},
                                 {"a_1", "a_root", 0},
                                 {"a_2", "a_1", 0}});
  EXPECT_EQ(RootOf(frames, ""), "a_root");
  EXPECT_EQ(RootOf(frames, "elsewhere"), "a_root");
  EXPECT_EQ(RootOf(frames, "b_1"), "b_root");
  EXPECT_THAT(RootOf(Hanging({{"loop_a", "loop_b", 0}, {"loop_b", "loop_a", 0}}), "loop_a"),
              StartsWith("loop_"));
}

// Frames and what they hang on.
std::unique_ptr<TfTree> TreeOf(const std::vector<std::pair<std::string, std::string>>& parents) {
  auto tf = std::make_unique<TfTree>();
  tf2_msgs::TFMessage message;
  for (const auto& [child, parent] : parents) {
    geometry_msgs::TransformStamped& transform = message.transforms.emplace_back();
    transform.child_frame_id = child;
    transform.header.frame_id = parent;
    transform.transform.rotation.w = 1;
  }
  tf->Add(message, true);
  return tf;
}

TEST(WhyNotFound, TellsWhatIsNotThereFromWhatHangsElsewhere) {
  const auto tree = TreeOf({{"cart", "map"}, {"lidar", "cart"}, {"arm", "world"}});
  const TfTree& tf = *tree;
  EXPECT_EQ(WhyNotFound(tf, "moon", "world"), "frame 'moon' is not known yet");
  EXPECT_EQ(WhyNotFound(tf, "map", "world"), "frame 'map' has no way to 'world' in TF");
  EXPECT_EQ(WhyNotFound(tf, "lidar", "world"),
            "frame 'lidar' hangs on 'map', which has no way to 'world' in TF");
  EXPECT_EQ(WhyNotFound(tf, "lidar", "unheard_of"),
            "frame 'lidar' hangs on 'map', which has no way to 'unheard_of' in TF");
  EXPECT_EQ(WhyNotFound(tf, "arm", "world"),
            "the transforms between 'arm' and 'world' have no time in common");
}

TEST(OtherTreeOf, IsTheRootOfWhatHasNoWay) {
  const auto tree =
      TreeOf({{"odom", "map"}, {"lidar", "odom"}, {"pelvis", "world"}, {"a", "b"}, {"b", "a"}});
  const TfTree& tf = *tree;
  EXPECT_EQ(OtherTreeOf(tf, "lidar", "world"), "map");
  EXPECT_EQ(OtherTreeOf(tf, "map", "world"), "map");
  EXPECT_EQ(OtherTreeOf(tf, "lidar", "unheard_of"), "map");
  EXPECT_EQ(OtherTreeOf(tf, "lidar", "odom"), "");
  EXPECT_EQ(OtherTreeOf(tf, "moon", "world"), "");
  EXPECT_EQ(OtherTreeOf(tf, "a", "world"), "") << "a loop is another matter";
}

TEST(WhyNotFound, NamesALoop) {
  const auto tree = TreeOf({{"a", "b"}, {"b", "c"}, {"c", "a"}, {"lidar", "b"}, {"arm", "world"}});
  const TfTree& tf = *tree;
  EXPECT_EQ(WhyNotFound(tf, "a", "world"), "frame 'a' is in a loop of TF: a, b, c, a");
  EXPECT_EQ(WhyNotFound(tf, "lidar", "world"), "frame 'lidar' hangs on a loop of TF: b, c, a, b");
  EXPECT_EQ(WhyNotFound(tf, "a", "c"), "frame 'a' is in a loop of TF: a, b, c, a");
}

TEST(WhyNotFound, TellsWhyTransformsWereSkipped) {
  TfTree tf;
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  message.transforms[0].child_frame_id = "lidar";
  message.transforms[0].header.frame_id = "world";
  tf.Add(message, false);
  EXPECT_EQ(WhyNotFound(tf, "lidar", "world"),
            "frame 'lidar' is not known: its transforms are those with a quaternion that is not of "
            "unit length");
}

TEST(WhyNotFound, IsOneLineOfBoundedLength) {
  const int count = 2'000;
  const auto name = [](int i) { return std::to_string(i) + std::string(200, '\n'); };
  std::vector<std::pair<std::string, std::string>> parents;
  for (int i = 0; i < count; ++i) parents.emplace_back(name(i), name((i + 1) % count));
  const std::string text = WhyNotFound(*TreeOf(parents), name(5), "world");
  EXPECT_THAT(text, HasSubstr("is in a loop of TF: 5"));
  EXPECT_LT(text.size(), 10'000u);
  EXPECT_EQ(text.find('\n'), std::string::npos);
}

TEST(WithoutPlace, SaysWhatAndWhy) {
  const TfTree tf;
  EXPECT_EQ((WithoutPlace{0, "a grid", "map", "; it stands at the origin"}.Text(tf, "world")),
            "a grid: frame 'map' is not known yet; it stands at the origin");
  EXPECT_EQ((WithoutPlace{0, "no calibration", "", ""}.Text(tf, "world")), "no calibration");
}

}  // namespace
}  // namespace kinescope::ros_bridge
