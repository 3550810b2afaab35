// The main job with everything real: a ROS master, `kinescope stream` as the suit, `kinescope
// serve`, a subscriber, a picture fetched over HTTP, and the page in Chromium.
#include <fmt/format.h>
#include <geometry_msgs/Point.h>
#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>
#include <unistd.h>
#include <urdf/model.h>
#include <visualization_msgs/MarkerArray.h>
#include <xsens_mvn_ros_msgs/LinkStateArray.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "render/camera/camera.h"
#include "render/image/png_file.h"
#include "server/picture/camera_controller.h"
#include "server/picture/picture_shapes.h"
#include "server/ros/bridge.h"
#include "server/scene/scene_builder.h"
#include "server/subject/subject.h"
#include "tests/folders.h"
#include "tests/process.h"
#include "tests/system/ros/ros_fixture.h"
#include "tests/system/run_program.h"

namespace kinescope {
namespace {

using testing::Process;
using testing::RunProgram;

// Counts what comes on each topic of the node, by stamp.
class Listener {
 public:
  explicit Listener(ros::NodeHandle& node) {
    Hear<sensor_msgs::JointState>(node, "joint_states",
                                  [](const auto& m) { return m.header.stamp; });
    Hear<xsens_mvn_ros_msgs::LinkStateArray>(
        node, "link_states", [](const auto& m) { return m.states.at(0).header.stamp; });
    Hear<geometry_msgs::Point>(node, kUnstamped, [](const auto&) { return ros::Time(1); });
    Hear<geometry_msgs::PointStamped>(node, "com_stamped",
                                      [](const auto& m) { return m.header.stamp; });
    Hear<visualization_msgs::MarkerArray>(
        node, "markers", [](const auto& m) { return m.markers.at(0).header.stamp; });
    Hear<tf2_msgs::TFMessage>(node, "/tf", [this](const auto& m) {
      for (const auto& transform : m.transforms) tf_children_.insert(transform.child_frame_id);
      return m.transforms.at(0).header.stamp;
    });
  }

  bool HasHeardEveryTopic() const {
    return std::none_of(stamps_.begin(), stamps_.end(),
                        [](const auto& topic) { return topic.second.empty(); });
  }
  // Whether what was stamped so has come on every topic that has stamps.
  bool HasHeard(const ros::Time& stamp) const {
    for (const auto& [topic, stamps] : stamps_)
      if (topic != kUnstamped && (stamps.empty() || stamps.back() < stamp)) return false;
    return true;
  }

  const std::map<std::string, std::vector<ros::Time>>& stamps() const { return stamps_; }
  const std::set<std::string>& tf_children() const { return tf_children_; }

  static constexpr char kUnstamped[] = "com";

 private:
  template <class Message, class StampOf>
  void Hear(ros::NodeHandle& node, const std::string& topic, StampOf stamp_of) {
    const std::string name = topic[0] == '/' ? topic : "/kinescope/" + topic;
    stamps_[topic];
    const boost::function<void(const boost::shared_ptr<const Message>&)> callback =
        [this, topic, stamp_of](const auto& message) {
          stamps_[topic].push_back(stamp_of(*message));
        };
    subscribers_.push_back(node.subscribe<Message>(name, 0, callback, ros::VoidConstPtr(),
                                                   ros::TransportHints().tcpNoDelay()));
  }

  std::vector<ros::Subscriber> subscribers_;
  std::map<std::string, std::vector<ros::Time>> stamps_;
  std::set<std::string> tf_children_;
};

class Pipeline : public testing::RosProgram {
 protected:
  void SetUp() override {
    RosProgram::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    // A busy machine holds the suit up, which is no reason for its person to turn grey here.
    server_ =
        Start("serve --source udp://127.0.0.1:0 --http_port 0 --ros required --stale_secs 60");
    suit_address_ = WaitForAddress(*server_);
    page_ = WaitForLine(*server_, "page at ");
  }

  // What the page's server says of the newest sample.
  nlohmann::json State() const {
    return nlohmann::json::parse(RunProgram({"/usr/bin/curl", "-sf", page_ + "api/v1/state"}).out);
  }

  std::unique_ptr<Process> server_;
  std::string suit_address_;  // udp://127.0.0.1:PORT
  std::string page_;          // http://127.0.0.1:PORT/
};

TEST_F(Pipeline, PublishesEverySampleOnceAtTheRateOfTheStream) {
  ros::NodeHandle node;
  Listener listener(node);
  const auto suit = Start("stream demo:lift --rate_hz 240 --to " + suit_address_);
  // Some samples pass before a subscriber is connected; of those after that, every one comes. The
  // suit's own counter and clock say how many they are and how far apart, however late they come.
  ASSERT_TRUE(Spin([&] { return listener.HasHeardEveryTopic(); }));
  const auto stamp_of = [](const nlohmann::json& state) {
    return ros::Time().fromNSec(state.at("stamp_nanos").get<std::uint64_t>());
  };
  const nlohmann::json first = State();
  nlohmann::json last;
  std::size_t samples = 0;
  ASSERT_TRUE(Spin([&] {
    last = State();
    samples = last.at("counter").get<std::size_t>() - first.at("counter").get<std::size_t>();
    return samples >= 600;
  }));
  ASSERT_TRUE(Spin([&] { return listener.HasHeard(stamp_of(last)); }));

  const double millis =
      last.at("time_code_millis").get<double>() - first.at("time_code_millis").get<double>();
  EXPECT_NEAR(millis, static_cast<double>(samples) * 1000 / 240, 1.01);
  for (const auto& [topic, stamps] : listener.stamps()) {
    if (topic == Listener::kUnstamped) continue;
    std::vector<ros::Time> between;
    std::copy_if(
        stamps.begin(), stamps.end(), std::back_inserter(between),
        [&](const ros::Time& stamp) { return stamp > stamp_of(first) && stamp <= stamp_of(last); });
    EXPECT_EQ(between.size(), samples) << topic;
    EXPECT_EQ(std::set<ros::Time>(between.begin(), between.end()).size(), samples)
        << topic << " has a sample twice";
  }
  for (int i = 0; i < urdf::kSegmentCount; ++i) {
    EXPECT_EQ(listener.tf_children().count(urdf::LinkName("skeleton", i)), 1u)
        << urdf::LinkName("skeleton", i);
  }

  ::urdf::Model model;
  ASSERT_TRUE(model.initString(WaitForParameter("/robot_description")));
  EXPECT_EQ(model.joints_.size(), 66u);
}

// How far a pixel is from the colour of the picture's upper left corner.
int DistanceFromBackground(const render::Image& image, double x, double y) {
  const auto at = [&](int column, int row) {
    return image.rgba.data() +
           4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                static_cast<std::size_t>(column));
  };
  const std::uint8_t* pixel = at(static_cast<int>(x), static_cast<int>(y));
  const std::uint8_t* background = at(image.width / 2, 2);
  int distance = 0;
  for (int i = 0; i < 3; ++i) distance = std::max(distance, std::abs(pixel[i] - background[i]));
  return distance;
}

TEST_F(Pipeline, ShowsThePersonAtTheStatesPositionAndOnThePage) {
  const auto suit = Start("stream demo:t_pose --to " + suit_address_);
  WaitForLine(*server_, "live: ");

  const std::string png = folder_.path() / "snapshot.png";
  const auto fetched =
      RunProgram({"/usr/bin/curl", "-sfo", png,
                  page_ + "api/v1/snapshot.png?camera=front&width=960&height=540"});
  ASSERT_EQ(fetched.exit_code, 0) << fetched.err;
  const render::Image image = render::ReadPng(png);
  std::shared_ptr<const SceneState> state;
  app::SceneBuilder builder({}, "", 0, [&](const auto& newest) { state = newest; });
  builder.OnCharacter(subject::MakeMotion("t_pose")->character());
  builder.OnSample(subject::MakeMotion("t_pose")->At(0));
  const render::Camera camera =
      app::CameraController(app::ParseCamera("front"), {})
          .OnlyLive(*state, app::PictureShapes().Of({960, 540, 2, "", true}, *state));
  const auto project = [&](const Eigen::Vector3d& point) {
    return render::Project(point, camera, image.width, image.height);
  };
  const PersonState& person = state->people.at(0);
  for (const int segment : {urdf::kHead, urdf::kT8, urdf::kRightHand, urdf::kLeftHand,
                            urdf::kRightLowerLeg, urdf::kLeftFoot}) {
    const urdf::Pose& link = person.links[static_cast<std::size_t>(segment)];
    const Eigen::Vector3d middle =
        link.position +
        link.orientation * (0.5 * urdf::EndOf(person.model->human.skeleton, segment));
    const render::Projected pixel = project(middle);
    EXPECT_GT(DistanceFromBackground(image, pixel.x_px, pixel.y_px), 25)
        << urdf::kSegments[static_cast<std::size_t>(segment)].mvn_name << " is not at "
        << pixel.x_px << ", " << pixel.y_px;
  }
  for (const Eigen::Vector3d& air : {Eigen::Vector3d(0, 0.6, 1.8), Eigen::Vector3d(0, -0.6, 1.8)}) {
    const render::Projected pixel = project(air);
    EXPECT_LT(DistanceFromBackground(image, pixel.x_px, pixel.y_px), 25)
        << "something is in the air";
  }

  const auto page =
      RunProgram({KINESCOPE_NODE, "--test",
                  kinescope::testing::InSourceTree("tests/browser/live_page.mjs").string()},
                 {"KINESCOPE_PAGE=" + page_,
                  "KINESCOPE_SCREENSHOTS=" + kinescope::testing::InBuild("screenshots").string()});
  EXPECT_EQ(page.exit_code, 0) << page.out << page.err;
}

TEST_F(Pipeline, AcceptsAHandLoadFromThePageAndShowsTheLoadedShoulder) {
  const auto suit = Start("stream demo:t_pose --to " + suit_address_);
  WaitForLine(*server_, "live: ");
  const auto page =
      RunProgram({KINESCOPE_NODE, "--test",
                  kinescope::testing::InSourceTree("tests/browser/hand_load_page.mjs").string()},
                 {"KINESCOPE_PAGE=" + page_,
                  "KINESCOPE_SCREENSHOTS=" + kinescope::testing::InBuild("screenshots").string()});
  EXPECT_EQ(page.exit_code, 0) << page.out << page.err;
}

TEST_F(Pipeline, ContinuesWithoutTheMaster) {
  const auto suit = Start("stream demo:walk --to " + suit_address_);
  WaitForLine(*server_, "live: ");
  master_.reset();
  // Live, and the counter goes on, long after the master went.
  const nlohmann::json first = State();
  EXPECT_EQ(first.at("liveness"), "live");
  EXPECT_TRUE(Spin(
      [&] { return State().at("counter").get<int>() > first.at("counter").get<int>() + 120; }));
}

}  // namespace
}  // namespace kinescope
