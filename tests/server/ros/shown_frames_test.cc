#include "server/ros/shown_frames.h"

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/system/clocks.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;
using ::testing::ElementsAre;

constexpr std::int64_t kEvery = kNanosPerSecond / 50;

class ShownFramesTest : public ::testing::Test {
 protected:
  void Set(const std::string& name, const std::string& parent, const Vector3d& at,
           std::int64_t stamp_nanos = 0) {
    tree_[name] = {name, parent, stamp_nanos};
    places_[name] = {at, Eigen::Quaterniond::Identity()};
  }

  bool UpdateAt(double secs) { return UpdateAt(secs, secs); }
  bool UpdateAt(double secs, double of_graph) {
    return frames_->Update(
        {static_cast<std::int64_t>(secs * kNanosPerSecond),
         static_cast<std::int64_t>(of_graph * kNanosPerSecond)},
        [&](const ShownFrames::TakeFrame& take) {
          for (const auto& [name, frame] : tree_) take(frame);
        },
        [&](const std::string& name) -> std::optional<urdf::Pose> {
          const auto found = places_.find(name);
          if (found == places_.end()) return std::nullopt;
          return found->second;
        });
  }

  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const auto& marker : frames_->markers()) {
      if (marker->type == MarkerType::kText) names.push_back(marker->text);
    }
    return names;
  }

  void Use(const ShownStyle& style) { frames_.emplace(style, kEvery); }

  std::optional<ShownFrames> frames_{std::in_place, ShownStyle{}, kEvery};
  std::map<std::string, TreeFrame> tree_;
  std::map<std::string, urdf::Pose> places_;
};

TEST_F(ShownFramesTest, AreAxesANameAndAnArrowToTheParent) {
  Set("world", "", {0, 0, 0});
  Set("cart", "world", {2, 0, 0});
  ASSERT_TRUE(UpdateAt(0));
  ASSERT_EQ(frames_->markers().size(), 5u);
  for (const auto& marker : frames_->markers()) EXPECT_FALSE(FindDefect(*marker));
  const SceneMarker& axes = *frames_->markers()[0];
  EXPECT_EQ(axes.type, MarkerType::kLineList);
  EXPECT_DOUBLE_EQ(axes.scale.x(), 0.02);
  ASSERT_EQ(axes.points.size(), 12u);  // "cart" first
  EXPECT_EQ(axes.points[0], Vector3d(2, 0, 0));
  EXPECT_EQ(axes.points[3], Vector3d(2, 0.2, 0));
  EXPECT_EQ(axes.colors[3], Vector4d(0, 1, 0, 1)) << "y is green";
  const SceneMarker& shaft = *frames_->markers()[1];
  EXPECT_DOUBLE_EQ(shaft.scale.x(), 0.01);
  EXPECT_THAT(shaft.points, ElementsAre(Vector3d(2, 0, 0), Vector3d(0.1, 0, 0)));
  const SceneMarker& head = *frames_->markers()[2];
  EXPECT_EQ(head.type, MarkerType::kTriangleList);
  double left = 1, right = -1, radius = 0;
  for (const Vector3d& point : head.points) {
    left = std::min(left, point.x());
    right = std::max(right, point.x());
    radius = std::max(radius, point.tail<2>().norm());
  }
  EXPECT_DOUBLE_EQ(left, 0) << "its tip is the parent";
  EXPECT_DOUBLE_EQ(right, 0.1);
  EXPECT_DOUBLE_EQ(radius, 0.02);
  EXPECT_THAT(Names(), ElementsAre("cart", "world"));
  const SceneMarker& name = *frames_->markers()[3];
  EXPECT_NEAR(name.scale.z(), 0.064, 1e-12);
  EXPECT_TRUE(name.pose.position.isApprox(Vector3d(2, 0, -0.032))) << "below its frame";
}

TEST_F(ShownFramesTest, AreWhatTheStyleHasOfThem) {
  Set("world", "", {0, 0, 0});
  Set("cart", "world", {2, 0, 0});
  ShownStyle style;
  style.size_m = 1;
  style.alpha = 0.5;
  style.frames.has_names = style.frames.has_arrows = false;
  style.frames.hidden = {"world"};
  Use(style);
  ASSERT_TRUE(UpdateAt(0));
  ASSERT_EQ(frames_->markers().size(), 1u);
  const SceneMarker& axes = *frames_->markers()[0];
  EXPECT_THAT(axes.points, ElementsAre(Vector3d(2, 0, 0), Vector3d(3, 0, 0), Vector3d(2, 0, 0),
                                       Vector3d(2, 1, 0), Vector3d(2, 0, 0), Vector3d(2, 0, 1)));
  EXPECT_EQ(axes.colors[0], Vector4d(1, 0, 0, 0.5));
  EXPECT_DOUBLE_EQ(axes.scale.x(), 0.1);
  style.frames.has_names = true;
  style.frames.name_m = 0.3;
  style.color = Rgb{1, 1, 1};
  Use(style);
  ASSERT_TRUE(UpdateAt(0));
  EXPECT_DOUBLE_EQ(frames_->markers().back()->scale.z(), 0.3);
  EXPECT_EQ(frames_->markers().back()->color, Vector4d(1, 1, 1, 1));
}

// As two TF displays of RViz.
TEST_F(ShownFramesTest, AreShownInTwoWaysAsMarkersOfTheirOwn) {
  Set("world", "", {0, 0, 0});
  ShownStyle large;
  large.size_m = 0.6;
  std::vector<ShownFrames> ways;
  for (const ShownStyle& style : {ShownStyle{}, large}) {
    frames_.emplace(style, kEvery, static_cast<int>(ways.size()));
    ASSERT_TRUE(UpdateAt(0));
    ways.push_back(*frames_);
  }
  std::set<int> ids;
  const MarkerList all = Together({}, ways);
  for (const auto& marker : all) ids.insert(marker->id);
  EXPECT_EQ(all.size(), 4u);
  EXPECT_EQ(ids.size(), all.size());
  EXPECT_DOUBLE_EQ(all[2]->scale.x(), 3 * all[0]->scale.x());
}

TEST_F(ShownFramesTest, ChangeOnlyWhenAFrameDoesAndNoMoreOftenThanTold) {
  Set("cart", "", {2, 0, 0});
  EXPECT_TRUE(UpdateAt(1));
  EXPECT_FALSE(UpdateAt(2)) << "nothing has moved";
  Set("cart", "", {3, 0, 0});
  EXPECT_FALSE(UpdateAt(2.01)) << "too early";
  EXPECT_TRUE(UpdateAt(2.03));
  Set("cart", "", {4, 0, 0});
  EXPECT_TRUE(UpdateAt(1)) << "a recording that is played again";
}

// While a bag is paused, or is played slowly.
TEST_F(ShownFramesTest, AgeByTheClockOfTheGraph) {
  ShownStyle style;
  style.frames.timeout_secs = 3;
  Use(style);
  Set("cart", "", {2, 0, 0}, 100);
  EXPECT_TRUE(UpdateAt(10, 500));
  EXPECT_FALSE(UpdateAt(20, 500));
  Set("cart", "", {3, 0, 0}, 100);
  EXPECT_TRUE(UpdateAt(21, 500)) << "but not how often they are looked at";
  EXPECT_TRUE(UpdateAt(22, 503));
  EXPECT_TRUE(frames_->markers().empty());
}

TEST_F(ShownFramesTest, TurnGreyThenPaleAndAreGoneIfTheyAreNotHeardOf) {
  ShownStyle style;
  style.frames.timeout_secs = 3;
  Use(style);
  Set("world", "", {0, 0, 0});
  Set("cart", "world", {2, 0, 0}, 100);
  Set("arm", "cart", {3, 0, 0});  // holds always, but what it hangs on does not
  const auto look = [&](double secs) {
    UpdateAt(secs);
    return frames_->markers().front()->colors.front();  // x of "arm"
  };
  EXPECT_EQ(look(10), Vector4d(1, 0, 0, 1));
  EXPECT_EQ(look(10.9), Vector4d(1, 0, 0, 1));
  EXPECT_TRUE(look(11.5).isApprox(Vector4d(0.85, 0.35, 0.35, 1), 1e-9));
  EXPECT_TRUE(look(12.5).isApprox(Vector4d(0.7, 0.7, 0.7, 0.5), 1e-9));
  EXPECT_TRUE(UpdateAt(13.1));
  EXPECT_THAT(Names(), ElementsAre("world"));
  Set("cart", "world", {2, 0, 0}, 200);
  EXPECT_EQ(look(13.2), Vector4d(1, 0, 0, 1)) << "a new transform";
}

TEST_F(ShownFramesTest, WithoutAWayAreNamedOnceIfItDoesNotCome) {
  Set("late", "", {0, 0, 0});
  tree_["lost"] = {"lost", "nowhere", 0};
  places_.erase("late");
  UpdateAt(0);
  EXPECT_EQ(frames_->TakeLost(), "") << "it may come";
  Set("late", "", {0, 0, 0});
  UpdateAt(0.9);
  EXPECT_EQ(frames_->TakeLost(), "");
  UpdateAt(1.1);
  EXPECT_EQ(frames_->TakeLost(), "frames without a way to that of the scene: lost");
  UpdateAt(2.2);
  EXPECT_EQ(frames_->TakeLost(), "");
}

// TF knows them for ten seconds, by times of which the others have no more.
TEST_F(ShownFramesTest, ThatAreNotHeardOfAnyMoreAreNotNamed) {
  Set("world", "", {0, 0, 0});
  Set("cart", "world", {2, 0, 0}, 100);
  UpdateAt(0);
  places_.erase("cart");
  for (const double secs : {10.0, 11.5}) UpdateAt(secs);
  EXPECT_EQ(frames_->TakeLost(), "");
  EXPECT_THAT(Names(), ElementsAre("world"));
}

TEST_F(ShownFramesTest, AreBoundedAndFarOnesAreLeftOut) {
  for (std::size_t i = 0; i < kMostShownFrames + 10; ++i) {
    Set("frame" + std::to_string(i), "", {0, 0, 0});
  }
  Set("a", "", {1e9, 0, 0});
  Set("b", "", {std::nan(""), 0, 0});
  UpdateAt(0);
  EXPECT_EQ(Names().size(), kMostShownFrames);
  for (const auto& marker : frames_->markers()) EXPECT_FALSE(FindDefect(*marker));
  UpdateAt(1.1);
  EXPECT_EQ(frames_->TakeLost(), "frames beyond 50 km: a, b");
}

TEST_F(ShownFramesTest, OfALoopHaveAnEnd) {
  Set("a", "b", {0, 0, 0}, 1);
  Set("b", "a", {1, 0, 0}, 1);
  EXPECT_TRUE(UpdateAt(0));
  EXPECT_THAT(Names(), ElementsAre("a", "b"));
}

TEST_F(ShownFramesTest, WithoutAPlaceAreNamedAsALoopIfTheyAreOne) {
  Set("a", "b", {0, 0, 0});
  Set("b", "a", {1, 0, 0});
  Set("below", "a", {1, 0, 0});
  Set("lost", "nowhere", {1, 0, 0});
  places_.clear();
  UpdateAt(0);
  UpdateAt(1.1);
  EXPECT_EQ(frames_->TakeLost(),
            "frames without a way to that of the scene: lost; frames in a loop or below it: a, b, "
            "below");
}

}  // namespace
}  // namespace kinescope::ros_bridge
