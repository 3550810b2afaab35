#include "server/ros/interactive_markers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "server/ros/marker_input.h"
#include "server/ros/topic_markers.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using visualization_msgs::InteractiveMarker;
using visualization_msgs::InteractiveMarkerControl;
using visualization_msgs::InteractiveMarkerInit;
using visualization_msgs::InteractiveMarkerPose;
using visualization_msgs::InteractiveMarkerUpdate;
using visualization_msgs::Marker;

// A box 0.1 m along x of the marker, which is at x in the frame "cart", turned by 90 degrees about
// z if told.
InteractiveMarker BoxAt(const std::string& name, double x, bool is_turned = false) {
  InteractiveMarker marker;
  marker.header.frame_id = "cart";
  marker.name = name;
  marker.scale = 1;
  marker.pose.position.x = x;
  marker.pose.orientation.w = is_turned ? std::sqrt(0.5) : 1;
  marker.pose.orientation.z = is_turned ? std::sqrt(0.5) : 0;
  Marker box;
  box.type = Marker::CUBE;
  box.pose.position.x = 0.1;
  box.scale.x = box.scale.y = box.scale.z = 0.2;
  box.color.a = 1;
  InteractiveMarkerControl control;
  control.always_visible = 1U;
  control.markers = {box};
  marker.controls = {control};
  return marker;
}

InteractiveMarkerInit AllOf(std::uint64_t number, const std::vector<InteractiveMarker>& markers) {
  InteractiveMarkerInit all;
  all.server_id = "server";
  all.seq_num = number;
  all.markers = markers;
  return all;
}

InteractiveMarkerUpdate Update(std::uint64_t number) {
  InteractiveMarkerUpdate update;
  update.server_id = "server";
  update.seq_num = number;
  update.type = InteractiveMarkerUpdate::UPDATE;
  return update;
}

InteractiveMarkerUpdate Moved(std::uint64_t number, const std::string& name, double x,
                              double yaw = 0) {
  InteractiveMarkerPose to;
  to.header.frame_id = "cart";
  to.name = name;
  to.pose.position.x = x;
  to.pose.orientation.z = std::sin(yaw / 2);
  to.pose.orientation.w = std::cos(yaw / 2);
  InteractiveMarkerUpdate update = Update(number);
  update.poses = {to};
  return update;
}

class InteractiveMarkersTest : public ::testing::Test {
 protected:
  // As the inboxes do it. @return why something was refused; "": nothing
  template <class Message>
  std::string Take(const Message& message) {
    ShownMarkers out;
    const auto refusal = markers_.Take(message, style_, out);
    for (const Marker& marker : out) {
      const auto unshown = store_.Apply(0, marker, 0);
      EXPECT_FALSE(unshown) << unshown->text;
    }
    const auto find = [](const std::string& frame, std::int64_t) -> std::optional<FramePlace> {
      if (frame != "cart" && frame != "tool") return std::nullopt;
      return FramePlace{{Vector3d(0, frame == "cart" ? 5 : 7, 0), Eigen::Quaterniond::Identity()}};
    };
    static_cast<void>(store_.Update(0, find));
    newest_ = out;
    return refusal ? refusal->text : "";
  }
  std::vector<Vector3d> places() const {
    std::vector<Vector3d> all;
    for (const auto& marker : store_.markers()) all.push_back(marker->pose.position);
    return all;
  }
  std::vector<double> xs() const {
    std::vector<double> all;
    for (const Vector3d& place : places()) all.push_back(std::round(1000 * place.x()) / 1000);
    return all;
  }

  ShownStyle style_;
  InteractiveMarkers markers_;
  MarkerStore store_;
  ShownMarkers newest_;
};

TEST_F(InteractiveMarkersTest, HaveTheMarkersOfTheirControlsInTheirPose) {
  EXPECT_EQ(Take(AllOf(1, {BoxAt("a", 1), BoxAt("b", 2, true)})), "");
  ASSERT_THAT(places(), SizeIs(2));
  EXPECT_TRUE(places()[0].isApprox(Vector3d(1.1, 5, 0)));
  EXPECT_TRUE(places()[1].isApprox(Vector3d(2, 5.1, 0)));
  EXPECT_TRUE(newest_.at(0).frame_locked) << "without a stamp it goes with its frame";
}

TEST_F(InteractiveMarkersTest, OfAFixedOrientationKeepTheAxesOfTheFrame) {
  InteractiveMarker fixed = BoxAt("a", 2, /*is_turned=*/true);
  fixed.controls[0].orientation_mode = InteractiveMarkerControl::FIXED;
  EXPECT_EQ(Take(AllOf(1, {fixed})), "");
  ASSERT_THAT(places(), SizeIs(1));
  EXPECT_TRUE(places()[0].isApprox(Vector3d(2.1, 5, 0)));
  EXPECT_EQ(Take(Moved(2, "a", 3, M_PI / 4)), "");
  EXPECT_TRUE(places()[0].isApprox(Vector3d(3.1, 5, 0)));
}

TEST_F(InteractiveMarkersTest, MoveChangeAndGoWithUpdates) {
  EXPECT_EQ(Take(AllOf(1, {BoxAt("a", 1), BoxAt("b", 2)})), "");
  EXPECT_EQ(Take(Moved(2, "a", 3, M_PI / 2)), "");
  EXPECT_TRUE(places().at(0).isApprox(Vector3d(3, 5.1, 0)));
  EXPECT_EQ(Take(Moved(3, "a", 3)), "");
  EXPECT_THAT(xs(), ElementsAre(3.1, 2.1)) << "from where its markers were at first";
  InteractiveMarkerUpdate changed = Update(4);
  changed.erases = {"a", "nobody"};
  changed.markers = {BoxAt("c", 8), BoxAt("b", 9)};
  EXPECT_EQ(Take(changed), "");
  EXPECT_THAT(xs(), ::testing::UnorderedElementsAre(8.1, 9.1));
  EXPECT_EQ(Take(Moved(5, "nobody", 3)), "");
  EXPECT_THAT(newest_, IsEmpty());
  InteractiveMarkerUpdate alive = Moved(5, "b", 0);
  alive.type = InteractiveMarkerUpdate::KEEP_ALIVE;
  EXPECT_EQ(Take(alive), "");
  EXPECT_THAT(newest_, IsEmpty());
}

TEST_F(InteractiveMarkersTest, TurnUnlessTheirControlIsFixed) {
  InteractiveMarker marker = BoxAt("a", 1);
  marker.controls[0].orientation_mode = InteractiveMarkerControl::FIXED;
  EXPECT_EQ(Take(AllOf(1, {marker})), "");
  EXPECT_EQ(Take(Moved(2, "a", 3, M_PI / 2)), "");
  EXPECT_TRUE(places().at(0).isApprox(Vector3d(3.1, 5, 0)));
}

TEST_F(InteractiveMarkersTest, WithAFrameOfTheirOwnStayInIt) {
  InteractiveMarker marker = BoxAt("a", 1);
  marker.controls[0].markers[0].header.frame_id = "tool";
  EXPECT_EQ(Take(AllOf(1, {marker})), "");
  EXPECT_TRUE(places().at(0).isApprox(Vector3d(0.1, 7, 0)));
  EXPECT_EQ(Take(Moved(2, "a", 3)), "");
  EXPECT_THAT(newest_, IsEmpty());
}

TEST_F(InteractiveMarkersTest, HaveTheirTitleTheirAxesAndTheHandlesOfRViz) {
  InteractiveMarker marker = BoxAt("a", 1);
  marker.description = "goal";
  InteractiveMarkerControl handle;
  handle.interaction_mode = InteractiveMarkerControl::MOVE_AXIS;
  handle.orientation.w = 1;
  marker.controls.push_back(handle);
  const auto types_of = [&] {
    std::map<int, int> types;
    markers_ = InteractiveMarkers();
    EXPECT_EQ(Take(AllOf(1, {marker})), "");
    for (const Marker& each : newest_) ++types[each.type];
    return types;
  };
  EXPECT_EQ(types_of(), (std::map<int, int>{{Marker::ARROW, 2},  // there and back
                                            {Marker::CUBE, 1},
                                            {Marker::TEXT_VIEW_FACING, 1}}));
  EXPECT_NEAR(newest_.at(1).color.a, 0.5, 0.3) << "translucent";
  style_.alpha = 1;
  style_.has_axes = true;
  style_.frames.has_names = false;
  EXPECT_EQ(types_of(),
            (std::map<int, int>{{Marker::ARROW, 2}, {Marker::CUBE, 1}, {Marker::LINE_LIST, 1}}));
  EXPECT_EQ(newest_.at(1).color.a, 1);
  style_.has_handles = false;
  EXPECT_EQ(types_of(), (std::map<int, int>{{Marker::CUBE, 1}, {Marker::LINE_LIST, 1}}))
      << "only what is always visible";
  marker.controls.clear();
  EXPECT_EQ(types_of(), (std::map<int, int>())) << "RViz calls it empty";
}

// Latched: it may come after the first updates.
TEST_F(InteractiveMarkersTest, AnOlderWholeAddsWhatNoUpdateSpokeOf) {
  InteractiveMarkerUpdate update = Update(7);
  update.markers = {BoxAt("a", 3)};
  update.erases = {"gone"};
  EXPECT_EQ(Take(update), "");
  EXPECT_EQ(Take(AllOf(6, {BoxAt("a", 1), BoxAt("b", 2), BoxAt("gone", 4)})), "");
  EXPECT_THAT(xs(), ::testing::UnorderedElementsAre(3.1, 2.1));
  EXPECT_EQ(Take(AllOf(7, {BoxAt("a", 4)})), "");
  EXPECT_THAT(newest_, IsEmpty()) << "the update had it";
  EXPECT_EQ(Take(AllOf(9, {BoxAt("d", 4)})), "");
  EXPECT_THAT(xs(), ElementsAre(4.1));
  EXPECT_EQ(Take(Moved(9, "d", 8)), "");
  EXPECT_THAT(newest_, IsEmpty()) << "the whole has it";
}

// Its topics are two connections: the move may come before the whole from before the move.
TEST_F(InteractiveMarkersTest, AreMovedByAnUpdateThatCameBeforeTheWhole) {
  EXPECT_EQ(Take(Moved(2, "a", 3)), "");
  EXPECT_THAT(xs(), IsEmpty());
  EXPECT_EQ(Take(AllOf(1, {BoxAt("a", 1)})), "");
  EXPECT_THAT(xs(), ElementsAre(3.1));
  EXPECT_EQ(Take(AllOf(2, {BoxAt("a", 3)})), "");
  EXPECT_THAT(xs(), ElementsAre(3.1));
}

TEST_F(InteractiveMarkersTest, OfAServerThatWasRestartedReplaceTheFormerOnes) {
  EXPECT_EQ(Take(AllOf(50, {BoxAt("a", 1)})), "");
  EXPECT_EQ(Take(Moved(51, "a", 2)), "");
  EXPECT_EQ(Take(AllOf(1, {BoxAt("b", 7)})), "");
  EXPECT_THAT(xs(), ElementsAre(7.1));
  EXPECT_EQ(Take(Moved(2, "b", 8)), "");
  EXPECT_THAT(xs(), ElementsAre(8.1));
  InteractiveMarkerUpdate first = Update(1);
  first.markers = {BoxAt("c", 5)};
  EXPECT_EQ(Take(first), "");
  EXPECT_THAT(xs(), ElementsAre(5.1)) << "also if an update tells first";
  EXPECT_EQ(Take(AllOf(1, {BoxAt("c", 5), BoxAt("d", 6)})), "");
  EXPECT_THAT(xs(), ::testing::UnorderedElementsAre(5.1, 6.1));
}

TEST_F(InteractiveMarkersTest, OfSeveralServersAreApart) {
  EXPECT_EQ(Take(AllOf(5, {BoxAt("a", 1)})), "");
  InteractiveMarkerInit other = AllOf(1, {BoxAt("a", 2)});
  other.server_id = "other";
  EXPECT_EQ(Take(other), "");
  EXPECT_THAT(xs(), ElementsAre(1.1, 2.1));
  for (int i = 0; i < 14; ++i) {
    other.server_id = std::to_string(i);
    EXPECT_EQ(Take(other), "");
  }
  other.server_id = "one more";
  EXPECT_EQ(Take(other), "the limit of 16 servers of a topic is reached");
}

TEST_F(InteractiveMarkersTest, TooManyAreRefusedBeforeTheyAreMade) {
  InteractiveMarker many = BoxAt("many", 1);
  many.controls.resize(300'000);
  EXPECT_THAT(Take(AllOf(1, {BoxAt("a", 1), many, BoxAt("b", 2)})),
              HasSubstr("the limit of 2000 markers"));
  EXPECT_THAT(xs(), ElementsAre(1.1, 2.1)) << "the others are there";
  for (std::uint64_t i = 2; i < 100; ++i) {
    InteractiveMarkerUpdate update = Update(i);
    for (int k = 0; k < 100; ++k) update.markers.push_back(BoxAt(std::to_string(k), k));
    EXPECT_EQ(Take(update), "") << "what is replaced does not count";
  }
  EXPECT_THAT(xs(), SizeIs(102));
}

TEST(TopicMarkers, AreNamedByTheServer) {
  const std::string type = ros::message_traits::md5sum<InteractiveMarkerInit>();
  ASSERT_TRUE(TopicMarkers::IsShown(type, {}));
  const InteractiveMarkerInit message = AllOf(1, {BoxAt("a", 1)});
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  TopicMarkers markers;
  ShownMarkers out;
  EXPECT_FALSE(markers.Take(0, "/lab/goals/update", {}, type, bytes, out));
  ASSERT_THAT(out, SizeIs(1));
  EXPECT_EQ(out[0].ns, "lab/goals");
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::vector<std::uint8_t> part(bytes.begin(),
                                         bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_TRUE(markers.Take(0, "/lab/goals/update", {}, type, part, out)) << size;
  }
  EXPECT_THAT(TopicsHeardFor({"/lab/goals"}), SizeIs(1));
  EXPECT_THAT(TopicsHeardFor({"/update"}), SizeIs(1)) << "of no server";
}

}  // namespace
}  // namespace kinescope::ros_bridge
