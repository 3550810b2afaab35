// Markers of other programs with everything real: a master, a bridge in a process of its own, and
// this test as the one who wants something to be seen.
#include <geometry_msgs/Point.h>
#include <gtest/gtest.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>

#include <limits>
#include <string>

#include "core/scene_marker.h"
#include "tests/folders.h"
#include "tests/system/ros/ros_fixture.h"

namespace kinescope {
namespace {

using visualization_msgs::Marker;

class MarkersOverRos : public testing::RosProgram {
 protected:
  void SetUp() override {
    RosProgram::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    bridge_ = std::make_unique<testing::Process>(std::vector<std::string>{
        kinescope::testing::InBuild("tests/system/marker_listener").string(),
        "/single,/many,/other"});
    single_ = Advertise<Marker>("/single");
    many_ = Advertise<visualization_msgs::MarkerArray>("/many");
    frames_ = Advertise<tf2_msgs::TFMessage>("/tf");
  }

  template <class Message>
  ros::Publisher Advertise(const std::string& topic) {
    ros::Publisher publisher = node_->advertise<Message>(topic, 100);
    EXPECT_TRUE(Spin([&] { return publisher.getNumSubscribers() > 0; })) << topic;
    return publisher;
  }

  void ListenAnewTo(const std::string& topics) {
    bridge_.reset();
    ASSERT_TRUE(Spin([&] { return frames_.getNumSubscribers() == 0; }));
    bridge_ = std::make_unique<testing::Process>(std::vector<std::string>{
        kinescope::testing::InBuild("tests/system/marker_listener").string(), topics});
    ASSERT_TRUE(Spin([&] { return frames_.getNumSubscribers() > 0; }));
  }

  // Until the scene is `expected`; what it was before is passed over.
  void Await(const std::string& expected) {
    std::string seen;
    while (const auto line = bridge_->ReadLine(kPatience)) {
      if (line->find(expected) != std::string::npos) return;
      seen += *line + "\n";
    }
    FAIL() << "never '" << expected << "' but:\n" << seen;
  }

  static Marker Of(int type, int id) {
    Marker marker;
    marker.header.frame_id = "world";
    marker.ns = "walls";
    marker.id = id;
    marker.type = type;
    marker.scale.x = marker.scale.y = marker.scale.z = 0.1;
    marker.color.a = 1;
    marker.points.resize(type == Marker::ARROW ? 2 : 6);
    for (std::size_t i = 0; i < marker.points.size(); ++i) marker.points[i].x = 0.1 * i;
    marker.text = "here";
    marker.mesh_resource = "package://walls/door.stl";
    return marker;
  }

  void SetCart(double x) {
    tf2_msgs::TFMessage message;
    message.transforms.resize(1);
    message.transforms[0].header.stamp = ros::Time(100 + x);
    message.transforms[0].header.frame_id = "world";
    message.transforms[0].child_frame_id = "cart";
    message.transforms[0].transform.translation.x = x;
    message.transforms[0].transform.rotation.w = 1;
    frames_.publish(message);
  }

  std::unique_ptr<testing::Process> bridge_;
  ros::Publisher single_, many_, frames_;
};

TEST_F(MarkersOverRos, AreShownAndDeletedForEveryType) {
  std::string all;
  for (int type = Marker::ARROW; type <= Marker::TRIANGLE_LIST; ++type) {
    single_.publish(Of(type, type));
    all += fmt::format("; {} walls/{} at 0.000 0.000 0.000", Name(static_cast<MarkerType>(type)),
                       type);
  }
  Await("12 markers" + all);
  Marker gone = Of(Marker::CUBE, 5);
  gone.action = Marker::DELETE;
  single_.publish(gone);
  Await("11 markers");
  gone.action = Marker::DELETEALL;
  single_.publish(gone);
  Await("0 markers");
}

TEST_F(MarkersOverRos, WaitForTheirFrameAndFollowItIfLocked) {
  visualization_msgs::MarkerArray array;
  array.markers = {Of(Marker::CUBE, 1), Of(Marker::SPHERE, 2)};
  for (Marker& marker : array.markers) marker.header.frame_id = "cart";
  array.markers[0].frame_locked = 1;
  many_.publish(array);
  SetCart(1);
  Await("2 markers; cube walls/1 at 1.000 0.000 0.000; sphere walls/2 at 1.000 0.000 0.000");
  SetCart(2);
  Await("2 markers; cube walls/1 at 2.000 0.000 0.000; sphere walls/2 at 1.000 0.000 0.000");
}

TEST_F(MarkersOverRos, AxesOfAFrameGoWithItAndThoseOfTheSceneStand) {
  ASSERT_NO_FATAL_FAILURE(ListenAnewTo("tf:cart,tf:"));
  Await("1 markers; line list rviz/Axes/0 at 0.000 0.000 0.000");
  SetCart(1);
  Await(
      "2 markers; line list rviz/Axes/0 at 1.000 0.000 0.000; line list rviz/Axes/0 at 0.000 0.000 "
      "0.000");
  SetCart(2);
  Await(
      "2 markers; line list rviz/Axes/0 at 2.000 0.000 0.000; line list rviz/Axes/0 at 0.000 0.000 "
      "0.000");
}

TEST_F(MarkersOverRos, AllFramesHaveTheirNames) {
  ASSERT_NO_FATAL_FAILURE(ListenAnewTo("tf:*"));
  Await("2 markers; line list tf/0 at 0.000 0.000 0.000; text tf/3 at 0.000 0.000 -0.032");
  SetCart(1);  // its axes, the arrow from it to the world, and both names
  Await(
      "5 markers; line list tf/0 at 0.000 0.000 0.000; line list tf/1 at 0.000 0.000 0.000; "
      "triangle list tf/2 at 0.000 0.000 0.000; text tf/3 at 1.000 0.000 -0.032; "
      "text tf/4 at 0.000 0.000 -0.032");
}

TEST_F(MarkersOverRos, OnALinkFollowThePerson) {
  Marker badge = Of(Marker::CYLINDER, 1);
  badge.header.frame_id = "skeleton_pelvis";
  badge.frame_locked = 1;
  single_.publish(badge);
  bridge_->WriteLine("0.5 0 1");
  Await("1 markers; cylinder walls/1 at 0.500 0.000 1.000");
  bridge_->WriteLine("0.7 0.1 1");
  Await("1 markers; cylinder walls/1 at 0.700 0.100 1.000");
}

TEST_F(MarkersOverRos, AreRemovedAfterTheirLifetime) {
  Marker brief = Of(Marker::CUBE, 1);
  brief.lifetime = ros::Duration(0.2);
  single_.publish(brief);
  Await("1 markers");
  Await("0 markers");
}

TEST_F(MarkersOverRos, AreCountedByTopicWithTheReasonIfRejected) {
  const ros::Publisher other = Advertise<geometry_msgs::Point>("/other");
  other.publish(geometry_msgs::Point());
  Marker lost = Of(Marker::CUBE, 3);
  lost.header.frame_id = "nowhere";
  visualization_msgs::MarkerArray array;
  array.markers = {lost};
  many_.publish(array);
  Marker nan = Of(Marker::CUBE, 7);
  nan.pose.position.x = std::numeric_limits<double>::quiet_NaN();
  single_.publish(nan);
  single_.publish(Of(Marker::CUBE, 8));
  Await("1 markers; cube walls/8");
  // A second good one on each topic, so that what came before it has been looked at.
  array.markers = {Of(Marker::CUBE, 9)};
  many_.publish(array);
  Await("2 markers");
  bridge_->WriteLine("end");
  Await("/many: 2 received, 2 used, 'marker walls/3: frame 'nowhere'");
  Await("/other: 1 received, 0 used, 'message type geometry_msgs/Point");
  Await("/single: 2 received, 1 used, 'marker walls/7: its position is not finite");
}

}  // namespace
}  // namespace kinescope
