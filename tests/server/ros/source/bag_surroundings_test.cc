// Markers that other nodes published into a bag stand beside the people, as RViz shows them.
#include "server/ros/source/bag_surroundings.h"

#include <geometry_msgs/PointStamped.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <map_msgs/OccupancyGridUpdate.h>
#include <nav_msgs/OccupancyGrid.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>
#include <visualization_msgs/InteractiveMarkerInit.h>
#include <visualization_msgs/InteractiveMarkerUpdate.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "core/system/errors.h"
#include "server/ros/link_states.h"
#include "server/ros/markers.h"
#include "server/ros/source/bag_source.h"
#include "server/ros/transforms.h"
#include "tests/captured_log.h"
#include "tests/recording_sink.h"
#include "tests/server/ros/test_person.h"
#include "tests/temp_folder.h"

namespace kinescope::ros_bridge {
namespace {

using testing::CapturedLog;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::Pair;
using testing::RecordingSink;
using testing::TempFolder;
using visualization_msgs::Marker;

constexpr std::int64_t kBegin = 1'600'000'000'000'000'000, kStep = 100'000'000;

ros::Time TimeOf(std::int64_t nanos) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(nanos));
  return time;
}

Marker CubeIn(const std::string& frame, int id, double x = 0) {
  Marker marker;
  marker.header.frame_id = frame;
  marker.ns = "walls";
  marker.id = id;
  marker.type = Marker::CUBE;
  marker.pose.position.x = x;
  marker.pose.orientation.w = 1;
  marker.scale.x = marker.scale.y = marker.scale.z = 0.2;
  marker.color.a = 1;
  return marker;
}

tf2_msgs::TFMessage FrameAt(const std::string& frame, double x, std::int64_t nanos) {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  auto& transform = message.transforms.front();
  transform.header.frame_id = "world";
  transform.header.stamp = TimeOf(nanos);
  transform.child_frame_id = frame;
  transform.transform.translation.x = x;
  transform.transform.rotation.w = 1;
  return message;
}

// Of sample `n`.
tf2_msgs::TFMessage TransformsOfSample(int n) {
  tf2_msgs::TFMessage message;
  const auto person =
      testing::MakePerson(testing::MakeModel("skeleton"), testing::Posture(0.05 * n),
                          static_cast<std::uint32_t>(n), kBegin + n * kStep);
  FillTransforms(person, PersonNames("skeleton"), "world", TfShape::kFlat, message);
  return message;
}

struct Recorded : RecordingSink {
  SourceCounters counters;
};

class BagSurroundingsTest : public ::testing::Test {
 protected:
  // Six samples of a person, and what `write` adds.
  Recorded Read(const std::function<void(rosbag::Bag&)>& write, const GraphView& view = {}) const {
    const std::string path = folder_ / "markers.bag";
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    for (int n = 0; n < 6; ++n) {
      bag.write("/tf", TimeOf(kBegin + n * kStep), TransformsOfSample(n));
    }
    write(bag);
    bag.close();
    Recorded recorded;
    const auto source = OpenBag(path, view);
    while (source->Poll({}, recorded) == Source::State::kMore) {
    }
    recorded.counters = source->counters();
    return recorded;
  }
  // How many markers each sample has.
  static std::vector<std::size_t> CountsOf(const Recorded& recorded) {
    std::vector<std::size_t> counts;
    for (const MarkerList& each : recorded.markers) counts.push_back(each.size());
    return counts;
  }

  TempFolder folder_;
};

GraphRobot Arm(const std::string& prefix = {}) {
  GraphRobot arm{{}, prefix, {}};
  arm.robot.name = "arm";
  arm.robot.model = std::make_shared<urdf::RobotModel>(urdf::ParseUrdf(
      "<robot name='arm'><link name='base'><visual><geometry><sphere radius='1'/></geometry>"
      "</visual></link><link name='hand'><visual><geometry><sphere radius='1'/></geometry>"
      "</visual></link><joint name='slide' type='prismatic'><parent link='base'/><child "
      "link='hand'/>"
      "<axis xyz='0 0 1'/><limit lower='0' upper='2' effort='1' velocity='1'/></joint></robot>"));
  return arm;
}

TEST_F(BagSurroundingsTest, AreRobotsWhereTransformsAndJointStatesHaveTheirLinks) {
  GraphView view;
  view.robots = {Arm("lab")};
  const CapturedLog log;
  const Recorded recorded = Read(
      [](rosbag::Bag& bag) {
        bag.write("/tf", TimeOf(kBegin + kStep - 2), FrameAt("lab/base", 3, kBegin + kStep - 2));
        bag.write("/tf", TimeOf(kBegin + 3 * kStep - 2),
                  FrameAt("lab/base", 4, kBegin + 3 * kStep - 2));
        sensor_msgs::JointState joints;
        joints.name = {"slide", "of_another"};
        joints.position = {0.5, 9};
        bag.write("/lab/joint_states", TimeOf(kBegin + 4 * kStep - 2), joints);
        joints.position = {0.9, 9};
        bag.write("/other/joint_states", TimeOf(kBegin + 4 * kStep - 1), joints);
      },
      view);
  ASSERT_EQ(recorded.robots.size(), 6u);
  const auto place_of = [&](std::size_t sample, std::size_t link) {
    return recorded.robots[sample].at(0)->world_from_link[link].translation();
  };
  EXPECT_TRUE(place_of(0, 0).hasNaN());
  EXPECT_EQ(recorded.robots[0][0]->problem,
            "robot 'arm': 2 of 2 links have no place in TF: lab/base, lab/hand");
  EXPECT_EQ(place_of(1, 0), Eigen::Vector3d(3, 0, 0));
  EXPECT_EQ(place_of(2, 0), Eigen::Vector3d(3, 0, 0));
  EXPECT_EQ(place_of(3, 0), Eigen::Vector3d(4, 0, 0));
  EXPECT_TRUE(place_of(3, 1).hasNaN());
  EXPECT_EQ(place_of(4, 1), Eigen::Vector3d(4, 0, 0.5)) << "chained by the joint";
  EXPECT_EQ(recorded.robots[5][0]->problem, "");
  EXPECT_EQ(recorded.counters.ignored.count("topic /other/joint_states (sensor_msgs/JointState)"),
            1u);
  EXPECT_THAT(log.text(), Not(HasSubstr("no frame")));
}

// Moments, and what was there at each.
struct Moments : SampleSink {
  void OnCharacter(const Character&) override { ++people; }
  void OnSample(const BodySample&) override { ++people; }
  void OnSurroundings(const RecordedSurroundings& all) override { shown = all; }
  void OnMoment(const SourceMoment& moment) override {
    EXPECT_EQ(moment.arrival_nanos, 0);
    stamps.push_back(moment.stamp_nanos);
    markers.push_back(shown.markers.empty() ? std::nan("")
                                            : shown.markers.front()->pose.position.x());
    robots.push_back(shown.robots.empty() ? std::nan("")
                                          : shown.robots[0]->world_from_link[0].translation().x());
  }
  RecordedSurroundings shown;
  int people = 0;
  std::vector<std::int64_t> stamps;
  std::vector<double> markers, robots;  // places of the first ones; NaN: nowhere
};

class BagWithoutPeople : public ::testing::Test {
 protected:
  std::string Write(const std::function<void(rosbag::Bag&)>& write) const {
    const std::string path = folder_ / "nobody.bag";
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    write(bag);
    bag.close();
    return path;
  }
  static Moments Read(const std::string& path, GraphView view = {}) {
    view.needs_person = false;
    Moments moments;
    const auto source = OpenBag(path, view);
    while (source->Poll({}, moments) == Source::State::kMore) {
    }
    EXPECT_EQ(moments.people, 0);
    return moments;
  }
  static std::string RefusalOf(const std::string& path, const GraphView& view) {
    try {
      (void)OpenBag(path, view);
      return "";
    } catch (const SourceError& error) {
      return error.what();
    }
  }

  TempFolder folder_;
};

TEST_F(BagWithoutPeople, ShowsRobotsAndMarkersInTheRootOfItsFrames) {
  const std::string path = Write([](rosbag::Bag& bag) {
    for (int n = 0; n < 4; ++n) {
      const std::int64_t now = kBegin + n * kStep;
      tf2_msgs::TFMessage frames = FrameAt("odom", 1, now);
      frames.transforms[0].header.frame_id = "map";
      frames.transforms.push_back(FrameAt("base", n, now).transforms[0]);
      frames.transforms[1].header.frame_id = "odom";
      bag.write("/tf", TimeOf(now), frames);
    }
    bag.write("/walls", TimeOf(kBegin + kStep + 1), CubeIn("map", 1, 7));
  });
  GraphView view;
  view.robots = {Arm()};
  const Moments moments = Read(path, view);
  EXPECT_THAT(moments.stamps, ElementsAre(kBegin, kBegin + kStep, kBegin + kStep + 1,
                                          kBegin + 2 * kStep, kBegin + 3 * kStep))
      << "the marker comes just after a moment";
  EXPECT_THAT(moments.robots, ElementsAre(1, 2, 2, 3, 4));
  EXPECT_TRUE(std::isnan(moments.markers[1]));
  EXPECT_EQ(moments.markers[2], 7);
}

TEST_F(BagWithoutPeople, ShowsFramesAloneIfTheyAreNamed) {
  const std::string path =
      Write([](rosbag::Bag& bag) { bag.write("/tf", TimeOf(kBegin), FrameAt("base", 1, kBegin)); });
  GraphView view;
  view.needs_person = false;
  EXPECT_THAT(RefusalOf(path, view), HasSubstr("no person"));
  ShownTopic all{kEveryFrame};
  all.is_frame = true;
  view.topics = {all};
  EXPECT_EQ(Read(path, view).stamps.size(), 1u);
  view.topics[0].name = "base";
  EXPECT_EQ(Read(path, view).stamps.size(), 1u);
}

// As `rosbag record` begins: with what is latched, within milliseconds.
TEST_F(BagWithoutPeople, BeginsWithAllThatIsRecordedAtOnce) {
  const std::string path = Write([](rosbag::Bag& bag) {
    bag.write("/tf_static", TimeOf(kBegin), FrameAt("base", 1, kBegin));
    bag.write("/walls", TimeOf(kBegin + 3'000'000), CubeIn("base", 1, 3));
  });
  const Moments moments = Read(path);
  EXPECT_THAT(moments.stamps, ElementsAre(kBegin));
  EXPECT_THAT(moments.markers, ElementsAre(4));
}

TEST_F(BagWithoutPeople, NeedsNoTransforms) {
  const std::string path = Write([](rosbag::Bag& bag) {
    bag.write("/walls", TimeOf(kBegin), CubeIn("laser", 1, 3));
    bag.write("/walls", TimeOf(kBegin + kStep), CubeIn("laser", 1, 4));
  });
  EXPECT_THAT(Read(path).markers, ElementsAre(3, 4));
}

TEST_F(BagWithoutPeople, IsRefusedWhereAPersonIsNeededOrNothingIsShown) {
  const std::string path =
      Write([](rosbag::Bag& bag) { bag.write("/walls", TimeOf(kBegin), CubeIn("map", 1, 3)); });
  EXPECT_THAT(RefusalOf(path, {}), HasSubstr("neither /tf nor link_states"));
  GraphView view;
  view.needs_person = false;
  const std::string other = Write([](rosbag::Bag& bag) {
    geometry_msgs::PointStamped point;
    point.header.frame_id = "map";
    bag.write("goal", TimeOf(kBegin), point);
  });
  EXPECT_THAT(RefusalOf(other, view), HasSubstr("if you name it: --marker_topics=/goal"));
  view.topics = {{"/goal"}};
  EXPECT_EQ(Read(other, view).stamps.size(), 1u);
}

// The ring goes with the link that its joint states move: TF has no frame of it. They are also
// those of a topic that the robot does not listen to.
// What is shown when, in seconds after the first sample.
struct Times : SampleSink {
  void OnCharacter(const Character&) override {}
  void OnSample(const BodySample& sample) override { samples.push_back(At(sample.stamp_nanos)); }
  void OnMoment(const SourceMoment& moment) override { moments.push_back(At(moment.stamp_nanos)); }
  double At(std::int64_t nanos) {
    if (samples.empty() && moments.empty()) first = nanos;
    return Secs(nanos - first);
  }
  std::vector<double> samples, moments;
  std::int64_t first = 0;
};

class BagThatPeopleLeave : public BagSurroundingsTest {
 protected:
  // A person up to 0.5 s and from 3 s on, and a frame of a robot from 0 to 5 s. The clock of the
  // person's stamps is an hour behind.
  Times TimesOf(const GraphView& view, bool with_link_states = false) const {
    const std::string path = folder_ / "left.bag";
    {
      rosbag::Bag bag(path, rosbag::bagmode::Write);
      for (int n = 0; n <= 50; ++n) {
        bag.write("/tf", TimeOf(kBegin + n * kStep + 1), FrameAt("base", 0.1 * n, kBegin));
        if (n > 5 && n < 30) continue;
        if (n > 35) continue;
        tf2_msgs::TFMessage person = TransformsOfSample(n);
        const ros::Duration hour(3600);
        for (auto& transform : person.transforms) transform.header.stamp -= hour;
        bag.write("/tf", TimeOf(kBegin + n * kStep), person);
        if (!with_link_states) continue;
        xsens_mvn_ros_msgs::LinkStateArray states;
        FillLinkStates(testing::MakePerson(testing::MakeModel("skeleton"),
                                           testing::Posture(0.05 * n), 0, kBegin + n * kStep),
                       "world", states);
        for (auto& state : states.states) state.header.stamp -= hour;
        bag.write("/skeleton/link_states", TimeOf(kBegin + n * kStep + 2), states);
      }
    }
    Times times;
    const auto source = OpenBag(path, view);
    while (source->Poll({}, times) == Source::State::kMore) {
    }
    return times;
  }
};

TEST_F(BagThatPeopleLeave, GoesOnWithWhatElseIsShown) {
  GraphView view;
  view.needs_person = false;
  view.robots = {Arm()};
  for (const bool with_link_states : {false, true}) {
    const Times times = TimesOf(view, with_link_states);
    EXPECT_EQ(times.samples.size(), 12u);
    ASSERT_EQ(times.moments.size(), 20u + 11u) << "of the gap and of the end";
    EXPECT_NEAR(times.moments.front(), 1.0, 1e-6);
    EXPECT_NEAR(times.moments[19], 2.9, 1e-6);
    EXPECT_NEAR(times.moments[20], 4.0, 1e-6);
    EXPECT_NEAR(times.moments.back(), 5.0, 1e-6);
  }
}

TEST_F(BagThatPeopleLeave, WaitsForTheSamplesOfASlowRecording) {
  const std::string path = folder_ / "slow.bag";
  {
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    for (int n = 0; n <= 60; ++n) {  // one sample a second
      const ros::Time now = TimeOf(kBegin + n * kStep);
      if (n % 10 == 0 && n <= 20) bag.write("/tf", now, TransformsOfSample(n));
      bag.write("/tf", now, FrameAt("base", n, kBegin));
    }
  }
  GraphView view;
  view.needs_person = false;
  view.robots = {Arm()};
  Times times;
  const auto source = OpenBag(path, view);
  while (source->Poll({}, times) == Source::State::kMore) {
  }
  EXPECT_EQ(times.samples.size(), 3u);
  ASSERT_EQ(times.moments.size(), 10u);
  EXPECT_NEAR(times.moments.front(), 5.1, 1e-6);
}

TEST_F(BagThatPeopleLeave, EndsWithThemIfNothingElseIsShown) {
  GraphView view;
  view.needs_person = false;
  EXPECT_TRUE(TimesOf(view).moments.empty());
  view.needs_person = true;
  view.robots = {Arm()};
  EXPECT_TRUE(TimesOf(view).moments.empty()) << "tables have people alone";
}

TEST_F(BagSurroundingsTest, AreEffortsOfJointsOfRobots) {
  GraphView view;
  GraphRobot arm = Arm();
  urdf::RobotModel model = *arm.robot.model;
  model.joints[0].type = urdf::RobotJoint::Type::kRevolute;
  arm.robot.model = std::make_shared<urdf::RobotModel>(std::move(model));
  view.robots = {arm};
  view.topics = {{"/joint_states"}, {"/measured"}};
  view.topics[1].style.color = Rgb{0, 1, 0};
  const CapturedLog log;
  const Recorded recorded = Read(
      [](rosbag::Bag& bag) {
        bag.write("/tf", TimeOf(kBegin - 2), FrameAt("base", 3, kBegin - 2));
        sensor_msgs::JointState joints;
        joints.name = {"slide"};
        joints.position = {0.5};
        joints.effort = {1};
        bag.write("/joint_states", TimeOf(kBegin + 2 * kStep - 2), joints);
        joints.name = {"of_another"};
        bag.write("/joint_states", TimeOf(kBegin + 2 * kStep - 1), joints);
        joints.name = {"slide"};
        bag.write("/measured", TimeOf(kBegin + 4 * kStep - 1), joints);
      },
      view);
  EXPECT_THAT(CountsOf(recorded), ElementsAre(0u, 0u, 2u, 2u, 4u, 4u));
  const SceneMarker& ring = *recorded.markers[2].at(0);
  EXPECT_EQ(ring.pose.position, Eigen::Vector3d(3, 0, 0));
  EXPECT_NEAR(Eigen::AngleAxisd(ring.pose.orientation).angle(), 0.5, 1e-9);
  EXPECT_EQ(recorded.counters.rejected.at("sensor_msgs/JointState: no such joint"), 1u);
  EXPECT_THAT(log.text(),
              HasSubstr("/joint_states: not shown: joint states: no robot that is shown "
                        "has the joint 'of_another'"));
}

TEST_F(BagSurroundingsTest, AreMarkersOfNamedTopicsAloneIfTold) {
  const auto write = [](rosbag::Bag& bag) {
    for (const char* const topic : {"/walls", "/trees"}) {
      bag.write(topic, TimeOf(kBegin - 2), CubeIn("world", 1));
    }
  };
  GraphView view;
  view.topics = {{"walls"}};
  EXPECT_THAT(CountsOf(Read(write, view)), Each(2u));
  view.topics.push_back({});
  view.topics.back().leaves_out_others = true;
  EXPECT_THAT(CountsOf(Read(write, view)), Each(1u));
  view.topics.push_back({"/walls"});
  view.topics.back().style.size_px = 3;
  EXPECT_THAT(CountsOf(Read(write, view)), Each(2u)) << "shown in two ways";
}

TEST_F(BagSurroundingsTest, NameOnceTheLinksThatHaveNoFrame) {
  GraphView view;
  view.robots = {Arm()};
  const CapturedLog log;
  Read([](rosbag::Bag&) {}, view);
  EXPECT_THAT(
      log.text(),
      HasSubstr("2 of 2 links have no place in TF: base, hand (frame 'base' is not known yet)"));
  const std::string once = log.text();
  Read([](rosbag::Bag&) {}, view);
  EXPECT_EQ(log.text(), once);
}

TEST_F(BagSurroundingsTest, AreMessagesOfTopicsThatAreNamed) {
  const auto write = [](rosbag::Bag& bag) {
    geometry_msgs::PointStamped point;
    point.header.frame_id = "world";
    point.point.x = 2;
    bag.write("/goal", TimeOf(kBegin + kStep / 2), point);
    point.point.x = std::numeric_limits<double>::quiet_NaN();
    bag.write("/goal", TimeOf(kBegin + 2 * kStep), point);
    bag.write("/other", TimeOf(kBegin + kStep / 2), point);
  };
  EXPECT_THAT(CountsOf(Read(write)), ElementsAre(0, 0, 0, 0, 0, 0));
  GraphView view;
  view.topics = {{"goal"}, {"/gaol"}};
  view.topics[0].style.color = Rgb{0, 0.5, 1};
  view.topics[0].style.alpha = 0.5;
  view.topics[0].style.size_m = 0.05;
  const CapturedLog log;
  const Recorded recorded = Read(write, view);
  EXPECT_THAT(CountsOf(recorded), ElementsAre(0, 1, 1, 1, 1, 1));
  EXPECT_EQ(recorded.markers.back()[0]->pose.position.x(), 2);
  EXPECT_EQ(recorded.markers.back()[0]->ns, "goal");
  EXPECT_EQ(recorded.markers.back()[0]->color, Eigen::Vector4d(0, 0.5, 1, 0.5));
  EXPECT_FLOAT_EQ(recorded.markers.back()[0]->scale.x(), 0.1F);
  EXPECT_THAT(recorded.counters.rejected,
              ElementsAre(Pair(HasSubstr("geometry_msgs/PointStamped: "), 1)));
  EXPECT_THAT(log.text(), HasSubstr("/goal: not shown: marker goal/0: its position is not finite"));
  EXPECT_THAT(log.text(), HasSubstr("no message that can be shown up to here on /gaol"));
}

// Of 2 x 1 px, with its calibration before it.
void WriteImage(rosbag::Bag& bag, const std::string& frame, std::int64_t nanos) {
  sensor_msgs::CameraInfo info;
  info.header.frame_id = frame;
  info.header.stamp = TimeOf(nanos);
  info.width = 2;
  info.height = 1;
  info.P = {2, 0, 0.5, 0, 0, 2, 0, 0, 0, 0, 1, 0};
  bag.write("/eye/camera_info", TimeOf(nanos), info);
  sensor_msgs::Image image;
  image.header.frame_id = frame;
  image.header.stamp = TimeOf(nanos);
  image.width = 2;
  image.height = 1;
  image.encoding = "16UC1";
  image.step = 4;
  image.data = {0xe8, 3, 0xe8, 3};  // 1 m
  bag.write("/eye/depth", TimeOf(nanos + 1), image);
}

TEST_F(BagSurroundingsTest, AreImagesWithTheirCamerasAndCloudsOfDepths) {
  ShownTopic picture{"/eye/depth"}, cloud{"eye/depth"};
  picture.style.camera.scene_opacity = 0.5;
  cloud.style.camera.is_cloud = true;
  const CapturedLog log;
  const auto write = [](const std::string& frame) {
    return [frame](rosbag::Bag& bag) {
      bag.write("/tf_static", TimeOf(kBegin - 9), FrameAt("eye", 3, kBegin - 9));
      for (int n = 0; n < 5; ++n) WriteImage(bag, frame, kBegin + n * kStep);
    };
  };
  const Recorded recorded = Read(write("eye"), {{picture, cloud}, {}});
  ASSERT_EQ(recorded.shown.images.size(), 1u);
  const CameraImage& image = *recorded.shown.images[0];
  EXPECT_EQ(image.name, "eye/depth");
  ASSERT_TRUE(image.camera);
  EXPECT_EQ(image.camera->world_from_optical.position, Eigen::Vector3d(3, 0, 0));
  EXPECT_EQ(image.camera->scene_opacity, 0.5);
  ASSERT_EQ(recorded.shown.markers.size(), 1u);
  const SceneMarker& points = *recorded.shown.markers[0];
  EXPECT_EQ(points.type, MarkerType::kPoints);
  EXPECT_EQ(points.pose.position, Eigen::Vector3d(3, 0, 0));
  ASSERT_EQ(points.points.size(), 2u);
  EXPECT_TRUE(points.points[0].isApprox(Eigen::Vector3d(-0.25, 0, 1), 1e-6));
  EXPECT_THAT(recorded.counters.rejected, IsEmpty());
  EXPECT_THAT(log.text(), Not(HasSubstr("eye")));
}

TEST_F(BagSurroundingsTest, SayOnceThatACameraHasNoPlace) {
  ShownTopic picture{"/eye/depth"};
  picture.style.camera.scene_opacity = 1;
  const CapturedLog log;
  const Recorded recorded = Read(
      [](rosbag::Bag& bag) {
        for (int n = 0; n < 30; ++n) {
          WriteImage(bag, "nowhere", kBegin + n * kStep);
          bag.write("/tf", TimeOf(kBegin + n * kStep + 2), TransformsOfSample(n + 1));
        }
      },
      {{picture}, {}});
  ASSERT_EQ(recorded.shown.images.size(), 1u);
  EXPECT_FALSE(recorded.shown.images[0]->camera);
  const std::string text = log.text();
  const std::size_t at =
      text.find("the scene is not drawn over its pictures: frame 'nowhere' is not known yet");
  ASSERT_NE(at, std::string::npos) << text;
  EXPECT_EQ(text.find("nowhere", at + 80), std::string::npos) << text;
}

TEST_F(BagSurroundingsTest, AreMarkersWithoutTheNamespacesThatAreLeftOut) {
  ShownTopic topic{"/markers"};
  topic.style.frames.hidden = {"walls"};
  const Recorded recorded = Read(
      [](rosbag::Bag& bag) {
        Marker door = CubeIn("world", 7);
        door.ns = "doors";
        bag.write("/markers", TimeOf(kBegin - 1), CubeIn("world", 1));
        bag.write("/markers", TimeOf(kBegin - 1), door);
        bag.write("/others", TimeOf(kBegin - 1), CubeIn("world", 2));
      },
      {{topic}, {}});
  ASSERT_THAT(CountsOf(recorded), ElementsAre(2, 2, 2, 2, 2, 2));
  EXPECT_EQ(recorded.markers[0][0]->id, 7);
  EXPECT_EQ(recorded.markers[0][1]->id, 2);
}

TEST_F(BagSurroundingsTest, AreInteractiveMarkersWithTheirUpdates) {
  visualization_msgs::InteractiveMarkerInit all;
  all.server_id = "goals";
  all.markers.resize(1);
  all.markers[0].header.frame_id = "world";
  all.markers[0].name = "goal";
  all.markers[0].controls.resize(1);
  all.markers[0].controls[0].always_visible = 1U;
  all.markers[0].controls[0].markers = {CubeIn("", 0)};
  visualization_msgs::InteractiveMarkerUpdate moved;
  moved.server_id = "goals";
  moved.seq_num = 1;
  moved.type = moved.UPDATE;
  moved.poses.resize(1);
  moved.poses[0].header.frame_id = "world";
  moved.poses[0].name = "goal";
  moved.poses[0].pose.position.x = 4;
  const Recorded recorded = Read(
      [&](rosbag::Bag& bag) {
        bag.write("/goals/update_full", TimeOf(kBegin - 1), all);
        bag.write("/goals/update", TimeOf(kBegin + 2 * kStep + 1), moved);
      },
      {{{"/goals/update"}}, {}});
  EXPECT_THAT(CountsOf(recorded), ElementsAre(1, 1, 1, 1, 1, 1));
  EXPECT_EQ(recorded.markers[2][0]->pose.position.x(), 0);
  EXPECT_EQ(recorded.markers[3][0]->pose.position.x(), 4);
  EXPECT_EQ(recorded.markers[3][0]->ns, "goals");
  EXPECT_THAT(recorded.counters.rejected, IsEmpty());
}

// A free map of two cells, then a wall in one of them.
TEST_F(BagSurroundingsTest, AreMapsWithTheirUpdatesIfTold) {
  nav_msgs::OccupancyGrid map;
  map.header.frame_id = "world";
  map.info.resolution = 0.5F;
  map.info.width = 2;
  map.info.height = 1;
  map.info.origin.orientation.w = 1;
  map.data = {0, 0};
  map_msgs::OccupancyGridUpdate update;
  update.header.frame_id = "world";
  update.x = 1;
  update.width = update.height = 1;
  update.data = {100};
  const auto write = [&](rosbag::Bag& bag) {
    bag.write("/map_updates", TimeOf(kBegin - 2), update);
    bag.write("/map", TimeOf(kBegin - 1), map);
    bag.write("/map_updates", TimeOf(kBegin + 2 * kStep + 1), update);
  };
  GraphView view;
  view.topics = {{"map"}};
  const Recorded frozen = Read(write, view);
  EXPECT_EQ(frozen.markers.at(5).at(0)->points.size(), 6u);
  EXPECT_THAT(frozen.counters.rejected, IsEmpty());
  view.topics[0].style.has_updates = true;
  const Recorded recorded = Read(write, view);
  EXPECT_THAT(CountsOf(recorded), ElementsAre(1, 1, 1, 1, 1, 1));
  EXPECT_EQ(recorded.markers[2][0]->points.size(), 6u);
  const SceneMarker& updated = *recorded.markers[3][0];
  ASSERT_EQ(updated.points.size(), 12u);
  EXPECT_EQ(updated.colors.at(0).head<3>(), Eigen::Vector3d(1, 1, 1));
  EXPECT_EQ(updated.colors.at(6).head<3>(), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(updated.ns, "map");
  EXPECT_THAT(recorded.counters.rejected,
              ElementsAre(Pair("map_msgs/OccupancyGridUpdate: no map yet", 1)));
}

TEST_F(BagSurroundingsTest, AreEarlierMessagesToo) {
  const auto write = [](rosbag::Bag& bag) {
    geometry_msgs::PointStamped point;
    point.header.frame_id = "world";
    for (int n = 0; n < 4; ++n) {
      point.point.x = n;
      bag.write("/goal", TimeOf(kBegin + n * kStep - 1), point);
    }
  };
  GraphView view;
  view.topics = {{"goal"}};
  view.topics[0].style.earlier.keep = 3;
  const Recorded kept = Read(write, view);
  EXPECT_THAT(CountsOf(kept), ElementsAre(1, 2, 3, 3, 3, 3));
  std::vector<double> places;
  for (const auto& marker : kept.markers.back()) places.push_back(marker->pose.position.x());
  EXPECT_THAT(places, ::testing::UnorderedElementsAre(1, 2, 3));
  view.topics[0].style.earlier.decay_secs = 0.25;
  EXPECT_THAT(CountsOf(Read(write, view)), ElementsAre(1, 2, 3, 3, 2, 1));
}

// At x = 3 m, then at 4 m.
void WriteCart(rosbag::Bag& bag) {
  for (const auto& [x, nanos] : {std::pair(3, kBegin + kStep / 2), {4, kBegin + 9 * kStep / 2}}) {
    bag.write("/tf", TimeOf(nanos), FrameAt("cart", x, nanos));
  }
}

TEST_F(BagSurroundingsTest, AreAxesOfFramesThatAreNamed) {
  GraphView view;
  view.topics = {{"cart", {}, true}};
  const Recorded recorded = Read(WriteCart, view);
  EXPECT_EQ(CountsOf(recorded).back(), 1u);
  const SceneMarker& axes = *recorded.markers.back().front();
  EXPECT_EQ(axes.ns, kNamespaceOfAxes);
  EXPECT_EQ(axes.type, MarkerType::kLineList);
  EXPECT_EQ(axes.pose.position.x(), 4);
  ASSERT_EQ(axes.colors.size(), 6u);
  EXPECT_EQ(axes.colors[2], Eigen::Vector4d(0, 1, 0, 1)) << "y is green";
  EXPECT_EQ(axes.points[3], Eigen::Vector3d(0, 1, 0));
}

TEST_F(BagSurroundingsTest, AreAllFramesWithTheirNamesIfTold) {
  GraphView view;
  view.topics = {{kEveryFrame, {}, true}};
  view.topics[0].style.frames.has_axes = view.topics[0].style.frames.has_arrows = false;
  const Recorded recorded = Read(WriteCart, view);
  std::map<std::string, double> places;
  for (const auto& marker : recorded.markers.back()) {
    places[marker->text] = marker->pose.position.x();
  }
  EXPECT_EQ(places.at("cart"), 4);
  EXPECT_EQ(places.at("world"), 0);
  EXPECT_EQ(places.count("skeleton_head"), 1u) << "those of the people, too";
}

TEST_F(BagSurroundingsTest, AreThereFromTheirTimeUntilTheyAreDeletedOrExpire) {
  const Recorded recorded = Read([](rosbag::Bag& bag) {
    Marker brief = CubeIn("world", 2, 5);
    brief.lifetime = ros::Duration(0.15);
    Marker gone = CubeIn("world", 1);
    gone.action = Marker::DELETE;
    bag.write("/walls", TimeOf(kBegin + kStep / 2), CubeIn("world", 1, 3));
    bag.write("/walls", TimeOf(kBegin + 2 * kStep - 1), brief);
    bag.write("/walls", TimeOf(kBegin + 4 * kStep + 1), gone);
  });
  EXPECT_THAT(CountsOf(recorded), ElementsAre(0, 1, 2, 2, 1, 0));
  const SceneMarker& cube = *recorded.markers[1].front();
  EXPECT_EQ(IdentityOf(cube), "walls/1");
  EXPECT_EQ(cube.pose.position, Eigen::Vector3d(3, 0, 0));
  EXPECT_THAT(recorded.counters.rejected, IsEmpty());
}

TEST_F(BagSurroundingsTest, BeforeTheFirstSampleStandBesideIt) {
  const Recorded recorded = Read([](rosbag::Bag& bag) {
    bag.write("/walls", TimeOf(kBegin - 1), CubeIn("world", 1));
    bag.write("/walls", TimeOf(kBegin - 1), CubeIn("", 2));
  });
  EXPECT_THAT(CountsOf(recorded), ElementsAre(2, 2, 2, 2, 2, 2));
}

TEST_F(BagSurroundingsTest, FollowTheirFrames) {
  const Recorded recorded = Read([](rosbag::Bag& bag) {
    Marker locked = CubeIn("cart", 1, 0.5);
    locked.frame_locked = 1;
    visualization_msgs::MarkerArray both;
    both.markers = {locked, CubeIn("table", 2)};
    bag.write("/tf_static", TimeOf(kBegin - 3), FrameAt("table", 7, kBegin - 3));
    bag.write("/walls", TimeOf(kBegin - 2), both);
    bag.write("/tf", TimeOf(kBegin - 1), FrameAt("cart", 1, kBegin - 1));
    bag.write("/tf", TimeOf(kBegin + 3 * kStep - 1), FrameAt("cart", 2, kBegin + 3 * kStep - 1));
  });
  ASSERT_THAT(CountsOf(recorded), ElementsAre(2, 2, 2, 2, 2, 2));
  EXPECT_EQ(recorded.markers[0][1]->pose.position, Eigen::Vector3d(7, 0, 0));
  EXPECT_EQ(recorded.markers[2][0]->pose.position, Eigen::Vector3d(1.5, 0, 0));
  EXPECT_EQ(recorded.markers[5][0]->pose.position, Eigen::Vector3d(2.5, 0, 0));
}

// A scan that is recorded before the transforms of its time.
TEST_F(BagSurroundingsTest, ThatComeBeforeTheirTransformsWaitForThem) {
  const Recorded recorded = Read([](rosbag::Bag& bag) {
    bag.write("/tf", TimeOf(kBegin - 2), FrameAt("cart", 1, kBegin - 2));
    Marker scan = CubeIn("cart", 1);
    scan.header.stamp = TimeOf(kBegin + 2 * kStep);
    bag.write("/scan", TimeOf(kBegin - 1), scan);
    bag.write("/tf", TimeOf(kBegin + 4 * kStep - 1), FrameAt("cart", 5, kBegin + 4 * kStep - 2));
  });
  ASSERT_THAT(CountsOf(recorded), ElementsAre(0, 0, 0, 0, 1, 1));
  EXPECT_NEAR(recorded.markers[5][0]->pose.position.x(), 3, 0.01) << "halfway, as it was";
}

TEST_F(BagSurroundingsTest, HaveTheAxesThatTheCameraGoesWith) {
  GraphView view;
  view.camera_frame = {"cart", "lab"};
  const Recorded recorded = Read(
      [](rosbag::Bag& bag) {
        bag.write("/tf", TimeOf(kBegin - 1), FrameAt("cart", 1, kBegin - 1));
        tf2_msgs::TFMessage lab = FrameAt("lab", 9, kBegin + 3 * kStep - 1);
        lab.transforms[0].transform.rotation.w = 0;
        lab.transforms[0].transform.rotation.z = 1;
        bag.write("/tf", TimeOf(kBegin + 3 * kStep - 1), lab);
      },
      view);
  ASSERT_EQ(recorded.camera_bases.size(), 6u);
  EXPECT_EQ(recorded.camera_bases[0].value().orientation.w(), 1) << "as the scene, for now";
  EXPECT_EQ(recorded.camera_bases[5].value().orientation.z(), 1);
  EXPECT_EQ(recorded.camera_bases[5].value().position, Eigen::Vector3d(1, 0, 0));
}

TEST_F(BagSurroundingsTest, HaveTheFrameThatTheCameraGoesWith) {
  GraphView view;
  view.camera_frame.at = "cart";
  const Recorded recorded = Read(
      [](rosbag::Bag& bag) {
        bag.write("/tf", TimeOf(kBegin + kStep - 1), FrameAt("cart", 1, kBegin + kStep - 1));
        bag.write("/tf", TimeOf(kBegin + 4 * kStep - 1),
                  FrameAt("cart", 2, kBegin + 4 * kStep - 1));
      },
      view);
  ASSERT_EQ(recorded.camera_bases.size(), 6u);
  EXPECT_FALSE(recorded.camera_bases[0]);
  EXPECT_EQ(recorded.camera_bases[1].value().position, Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(recorded.camera_bases[3].value().position, Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(recorded.camera_bases[5].value().position, Eigen::Vector3d(2, 0, 0));
}

TEST_F(BagSurroundingsTest, InAFrameThatIsNotThereAreNamedOnce) {
  const CapturedLog log;
  const Recorded recorded = Read([](rosbag::Bag& bag) {
    for (int n = 0; n < 5; ++n) {
      bag.write("/walls", TimeOf(kBegin + n * kStep), CubeIn("moon", 1));
    }
  });
  EXPECT_THAT(CountsOf(recorded), ElementsAre(0, 0, 0, 0, 0, 0));
  EXPECT_THAT(log.text(), HasSubstr("marker walls/1: frame 'moon' is not known yet"));
}

TEST_F(BagSurroundingsTest, ThatCannotBeDrawnAreCountedByReasonAndNamed) {
  const CapturedLog log;
  const Recorded recorded = Read([](rosbag::Bag& bag) {
    Marker flat = CubeIn("world", 1), unknown = CubeIn("world", 2);
    flat.scale.x = std::numeric_limits<double>::quiet_NaN();
    unknown.action = 17;
    bag.write("/walls", TimeOf(kBegin), flat);
    bag.write("/walls", TimeOf(kBegin), unknown);
    bag.write("/walls", TimeOf(kBegin), CubeIn("world", 3));
  });
  EXPECT_THAT(CountsOf(recorded), ElementsAre(0, 1, 1, 1, 1, 1));
  EXPECT_THAT(recorded.counters.rejected,
              ElementsAre(Pair("visualization_msgs/Marker: its scale", 1),
                          Pair("visualization_msgs/Marker: unknown action", 1)));
  EXPECT_THAT(log.text(), HasSubstr("/walls: not shown: marker walls/1: its scale is not finite"));
  EXPECT_THAT(log.text(), HasSubstr("/walls: not shown: marker walls/2: action 17"));
}

TEST_F(BagSurroundingsTest, OfKinescopeAreDrawnByTheSceneItself) {
  const Recorded recorded = Read([](rosbag::Bag& bag) {
    Marker own = CubeIn("world", 1);
    own.ns = "loads";
    visualization_msgs::MarkerArray array;
    array.markers = {own};
    bag.write("/kinescope/markers", TimeOf(kBegin), array);
  });
  EXPECT_THAT(CountsOf(recorded), ElementsAre(0, 0, 0, 0, 0, 0));
  EXPECT_THAT(recorded.counters.ignored, ElementsAre(Pair("markers of Kinescope", 1)));
}

}  // namespace
}  // namespace kinescope::ros_bridge
