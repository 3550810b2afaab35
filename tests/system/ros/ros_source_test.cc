// Kinescope beside a bridge that is there already: the source `ros:` against a real master and real
// publishers, in processes of their own.
#include <gmock/gmock.h>
#include <ros/network.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>
#include <xmlrpcpp/XmlRpcClient.h>
#include <xsens_mvn_ros_msgs/LinkStateArray.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "server/ros/names.h"
#include "server/ros/source/bag_source.h"
#include "server/ros/transforms.h"
#include "tests/recording_sink.h"
#include "tests/server/ros/test_person.h"
#include "tests/shared_data.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/ros/ros_fixture.h"
#include "tests/system/run_program.h"
#include "tests/temp_folder.h"

namespace kinescope {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Process;
using testing::RunProgram;
using xsens_mvn_ros_msgs::LinkStateArray;

class RosSource : public testing::RosProgram {
 protected:
  // What a node answers itself.
  static XmlRpc::XmlRpcValue Ask(const std::string& node, const char* method,
                                 const XmlRpc::XmlRpcValue* argument = nullptr) {
    XmlRpc::XmlRpcValue arguments, reply, uri;
    arguments[0] = ros::this_node::getName();
    arguments[1] = node;
    EXPECT_TRUE(ros::master::execute("lookupNode", arguments, reply, uri, false)) << node;
    std::string host;
    std::uint32_t port = 0;
    EXPECT_TRUE(ros::network::splitURI(uri, host, port));
    XmlRpc::XmlRpcValue question;
    question[0] = ros::this_node::getName();
    if (argument != nullptr) question[1] = *argument;
    XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
    EXPECT_TRUE(client.execute(method, question, reply)) << method;
    return reply;
  }

  // How many connections `node` sends `topic` over.
  static int ReceiversOf(const std::string& node, const std::string& topic) {
    XmlRpc::XmlRpcValue reply = Ask(node, "getBusInfo");
    XmlRpc::XmlRpcValue& connections =
        reply[2];  // each [id, who, "o" or "i", transport, topic, ...]
    int count = 0;
    for (int i = 0; i < connections.size(); ++i) {
      const bool is_out = connections[i][2] == XmlRpc::XmlRpcValue("o");
      count += is_out && connections[i][4] == XmlRpc::XmlRpcValue(topic) ? 1 : 0;
    }
    return count;
  }

  // What /api/v1/diagnostics says about the source.
  static nlohmann::json SourceAt(const std::string& page) {
    const auto text = RunProgram({"/usr/bin/curl", "-sf", page + "api/v1/diagnostics"}).out;
    return nlohmann::json::parse(text).value("source", nlohmann::json::object());
  }

  // Link states of both nodes by stamp, until `samples` came from both; and who is on /tf.
  void Compare(int samples) {
    Hear<LinkStateArray>("/suit/link_states",
                         [this](const auto& message) { theirs_[message.header.stamp] = message; });
    Hear<LinkStateArray>("/view/link_states",
                         [this](const auto& message) { ours_[message.header.stamp] = message; });
    EXPECT_TRUE(Spin([&] { return CompareWhatCame() >= samples; }))
        << compared_ << " of " << samples << " samples came both ways; " << theirs_.size()
        << " of the suit's wait, and " << ours_.size() << " of ours";
    fmt::print("{} samples; worst {:.1e} m, {:.1e} rad, {:.1e} m/s\n", compared_, worst_metres_,
               worst_radians_, worst_velocity_);
    EXPECT_LT(worst_metres_, 1e-6);
    EXPECT_LT(worst_radians_, 1e-6);
  }

  double worst_velocity_ = 0;  // m/s, rad/s

 private:
  int CompareWhatCame() {
    while (!ours_.empty()) {
      const auto [stamp, ours] = *ours_.begin();
      const auto theirs = theirs_.find(stamp);
      // The very first of them may have been published before we heard that topic.
      const bool is_passed = !theirs_.empty() && theirs_.begin()->first > stamp;
      if (theirs == theirs_.end() && !is_passed) break;
      if (theirs != theirs_.end()) CompareOne(ours, theirs->second);
      theirs_.erase(theirs_.begin(), theirs_.upper_bound(stamp));
      ours_.erase(ours_.begin());
    }
    return compared_;
  }

  void CompareOne(const LinkStateArray& ours, const LinkStateArray& theirs) {
    ASSERT_EQ(ours.states.size(), theirs.states.size());
    for (std::size_t i = 0; i < ours.states.size(); ++i) {
      const auto& a = ours.states[i];
      const auto& b = theirs.states[i];
      ASSERT_EQ(a.header.frame_id, b.header.frame_id);
      const auto& p = a.pose;
      const auto& q = b.pose;
      const Eigen::Vector3d moved(p.position.x - q.position.x, p.position.y - q.position.y,
                                  p.position.z - q.position.z);
      const Eigen::Quaterniond turned =
          Eigen::Quaterniond(p.orientation.w, p.orientation.x, p.orientation.y, p.orientation.z)
              .conjugate() *
          Eigen::Quaterniond(q.orientation.w, q.orientation.x, q.orientation.y, q.orientation.z);
      const auto& v = a.twist;
      const auto& w = b.twist;
      worst_metres_ = std::max(worst_metres_, moved.norm());
      worst_radians_ = std::max(worst_radians_, 2 * turned.vec().norm());
      worst_velocity_ =
          std::max({worst_velocity_, std::abs(v.linear.x - w.linear.x),
                    std::abs(v.linear.y - w.linear.y), std::abs(v.angular.z - w.angular.z)});
    }
    ++compared_;
  }

  std::map<ros::Time, LinkStateArray> ours_, theirs_;
  int compared_ = 0;
  double worst_metres_ = 0, worst_radians_ = 0;
};

TEST_F(RosSource, ShowsTheSamePosesAsTheBridgeThatPublishesItsFrames) {
  const auto suit = Start("bridge demo:lift --ros required --tf flat __name:=suit");
  const auto view = Start("bridge ros: __name:=view");
  Compare(100);
}

TEST_F(RosSource, ShowsTheSamePosesFromATreeWithoutPublishingFrames) {
  const auto suit = Start("bridge demo:lift --ros required --tf tree __name:=suit");
  const auto view = Start("bridge ros: --tf flat __name:=view");
  WaitForLine(*view, "not republished");
  std::set<std::string> publishers;
  const boost::function<void(const ros::MessageEvent<const tf2_msgs::TFMessage>&)> note =
      [&](const auto& event) { publishers.insert(event.getPublisherName()); };
  subscribers_.push_back(node_->subscribe<tf2_msgs::TFMessage>("/tf", 0, note));
  Compare(400);  // longer than it listens for frames that the suit may lack
  EXPECT_THAT(publishers, ElementsAre("/suit"));
}

TEST_F(RosSource, PublishesTheFramesInsideTheJointsOfANodeThatHasTheSegmentsAlone) {
  const ros::Publisher publisher = node_->advertise<tf2_msgs::TFMessage>("/tf", 100);
  const auto view = Start("bridge ros: __name:=view");
  std::map<std::string, tf2_msgs::TFMessage> heard;  // by publisher
  const boost::function<void(const ros::MessageEvent<const tf2_msgs::TFMessage>&)> note =
      [&](const auto& event) { heard[event.getPublisherName()] = *event.getMessage(); };
  subscribers_.push_back(node_->subscribe<tf2_msgs::TFMessage>("/tf", 0, note));
  const auto model = testing::MakeModel();
  const ros_bridge::PersonNames names(model->human);
  std::uint32_t n = 0;
  ASSERT_TRUE(Spin([&] {
    const auto now = static_cast<std::int64_t>(ros::Time::now().toNSec());
    tf2_msgs::TFMessage message;
    const auto person = testing::MakePerson(model, testing::Posture(1e-3 * n), n, now);
    ros_bridge::FillTransforms(person, names, "world", ros_bridge::TfShape::kFlat, message);
    message.transforms.resize(urdf::kSegmentCount);
    publisher.publish(message);
    ++n;
    return heard.count("/view") != 0;
  }));
  std::set<std::string> expected, frames;
  for (const auto& both : names.between) expected.insert(both.begin(), both.end());
  for (const auto& one : heard["/view"].transforms) frames.insert(one.child_frame_id);
  EXPECT_EQ(frames, expected);
}

// A suit that somebody else's driver put on /tf, next to a robot with a head and hands of its own:
// played as it was recorded, it gives the samples that reading the recording gives.
TEST_F(RosSource, ReceivesTheSamplesOfAReplayedBag) {
  KINESCOPE_NEEDS_SHARED_DATA("ros1/2018-05-28-17-34-45.bag.xz");
  const std::string path = testing::SharedData("ros1/2018-05-28-17-34-45.bag.xz");
  kinescope::testing::RecordingSink read;
  const auto offline = ros_bridge::OpenBag(path);
  while (offline->Poll(std::chrono::milliseconds(0), read) == Source::State::kMore) {
  }
  ASSERT_EQ(read.samples.size(), 135U);
  const ros::Publisher publisher = node_->advertise<tf2_msgs::TFMessage>("/tf", 5000);
  const auto view = Start("bridge ros: __name:=view");
  std::vector<LinkStateArray> live;
  Hear<LinkStateArray>("/view/link_states", [&](const auto& message) { live.push_back(message); });
  ASSERT_TRUE(Spin([&] {
    return publisher.getNumSubscribers() > 0 && subscribers_.back().getNumPublishers() > 0;
  }));

  const testing::TempFolder folder;
  const std::string unpacked = folder / "recording.bag";
  std::filesystem::copy(path, unpacked + ".xz");
  ASSERT_EQ(RunProgram({"/usr/bin/xz", "-d", unpacked + ".xz"}).exit_code, 0);
  const rosbag::Bag bag(unpacked, rosbag::bagmode::Read);
  rosbag::View recording(bag, rosbag::TopicQuery("/tf"));
  const auto start = Clock::now();
  for (const rosbag::MessageInstance& message : recording) {
    const double secs = (message.getTime() - recording.getBeginTime()).toSec();
    const auto due =
        start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(secs));
    std::this_thread::sleep_until(due);  // the pace of the recording, not a wait for something
    publisher.publish(message.instantiate<tf2_msgs::TFMessage>());
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0));
  }
  const auto same = [&](const LinkStateArray& array) -> const BodySample* {
    const auto& p = array.states.at(12).pose.position;  // the pelvis
    for (const BodySample& sample : read.samples) {
      if (sample.segments[urdf::kPelvis].position == Eigen::Vector3d(p.x, p.y, p.z)) return &sample;
    }
    return nullptr;
  };
  EXPECT_TRUE(Spin([&] { return !live.empty() && same(live.back()) == &read.samples.back(); }))
      << live.size() << " samples came";
  EXPECT_GT(live.size(), 100U) << "all but those of the first third of a second";
  for (const LinkStateArray& array : live) {
    const BodySample* sample = same(array);
    ASSERT_TRUE(sample != nullptr);
    for (std::size_t i = 0; i < array.states.size(); ++i) {
      const auto& p = array.states[i].pose.position;
      const auto& q = array.states[i].pose.orientation;
      const int segment = ros_bridge::SegmentsByName()[i];
      const SegmentState& state = sample->segments[urdf::At(segment)];
      EXPECT_EQ(state.position, Eigen::Vector3d(p.x, p.y, p.z)) << array.states[i].header.frame_id;
      const Eigen::Quaterniond link = state.orientation * urdf::SegmentFromLink(segment);
      EXPECT_LT((link.conjugate() * Eigen::Quaterniond(q.w, q.x, q.y, q.z)).vec().norm(), 1e-12);
    }
  }
}

TEST_F(RosSource, ReadsVelocitiesFromLinkStates) {
  const auto suit = Start("bridge demo:lift --ros required --tf off __name:=suit");
  const auto view = Start("bridge ros:/suit/link_states __name:=view");
  Compare(100);
  EXPECT_EQ(worst_velocity_, 0);
}

TEST_F(RosSource, IgnoresItsOwnMessages) {
  const auto suit = Start(
      "bridge demo:lift --ros required --tf off __name:=suit /suit/link_states:=/loop/link_states");
  const auto view = Start(
      "serve ros:/loop/link_states --http_port 0 --pictures off __name:=view "
      "/view/link_states:=/loop/link_states");
  const std::string page = WaitForLine(*view, "page at ");
  EXPECT_TRUE(Spin([&] {
    const auto source = SourceAt(page);
    const auto ignored = source.value("ignored", nlohmann::json::object());
    EXPECT_EQ(source.value("duplicates", 0), 0);
    EXPECT_EQ(source.value("restarts", 0), 0);
    return ignored.value("message published by this node", 0) > 50;
  }));
}

TEST_F(RosSource, MeasuresTheSegmentLengthsOfThePublishedUrdf) {
  const auto suit = Start("bridge demo:lift --ros required __name:=suit");
  const auto urdf_of = [](const std::string& source) {
    return RunProgram(
        {testing::KinescopePath(), "urdf", source, "--body_model", "primitive", "__name:=asks"});
  };
  const auto live = urdf_of("ros:");
  ASSERT_EQ(live.exit_code, 0) << live.err;
  // The knee, as one of the joints whose place is a length alone.
  const auto knee = [](const std::string& xml) {
    const std::string tag = "<joint name=\"skeleton_left_knee_y\"";
    const std::size_t joint = xml.find(tag);
    const std::size_t at = xml.find("xyz=\"", joint);
    double x = 0, y = 0, z = 0;
    EXPECT_EQ(std::sscanf(xml.c_str() + at, "xyz=\"%lf %lf %lf", &x, &y, &z), 3);
    return Eigen::Vector3d(x, y, z);
  };
  EXPECT_LT((knee(live.out) - knee(urdf_of("demo:lift").out)).norm(), 1e-6);
}

// Without a name of its own: it must not end the node that it looks at.
TEST_F(RosSource, IsInspectedLikeOtherSources) {
  const auto suit = Start("bridge demo:walk --ros required");
  int heard = 0;
  Hear<tf2_msgs::TFMessage>("/tf", [&](const auto&) { ++heard; });
  ASSERT_TRUE(Spin([&] { return heard > 0; }));
  Process program({"/bin/bash", "-c",
                   "'" + testing::KinescopePath() +
                       "' inspect ros: --seconds 600 --json & child=$!; trap "
                       "'kill -INT $child' TERM; wait $child; wait $child; echo exit $?"});
  ASSERT_TRUE(Spin([&] { return ReceiversOf("/kinescope", "/tf") == 2; })) << "we and the program";
  const int before = heard;
  ASSERT_TRUE(Spin([&] { return heard > before + 120; }));
  program.Signal(SIGTERM);
  std::string out;
  std::optional<std::string> line = program.ReadLine(kPatience);
  for (; line && line->rfind("exit ", 0) != 0; line = program.ReadLine(kPatience)) out += *line;
  ASSERT_EQ(line, "exit 0");
  const auto report = nlohmann::json::parse(out);
  EXPECT_EQ(report.at("format"), "ROS graph");
  EXPECT_EQ(report.at("live"), true);
  EXPECT_EQ(report.at("characters").at(0).at("name"), "skeleton");
  EXPECT_GT(report.at("characters").at(0).at("samples").at("count"), 30);
}

TEST_F(RosSource, WaitsForAMasterAndFindsPublishersAfterItsRestart) {
  const std::string uri = std::getenv("ROS_MASTER_URI");
  master_.reset();
  const auto view = Start("bridge ros: __name:=view");
  WaitForLine(*view, "waiting for a ROS master at " + uri);
  StartMaster();
  WaitForLine(*view, "subscribed through the ROS master");
  auto suit = Start("bridge demo:lift __name:=suit");
  WaitForLine(*view, "live: 'skeleton' from ros:/tf");

  master_.reset();
  WaitForLine(*view, "ros:/tf: the ROS master at " + uri + " does not answer");
  suit.reset();  // until here it was heard without a master
  WaitForLine(*view, "stale:");
  StartMaster();
  WaitForLine(*view, "subscribed through the ROS master");
  suit = Start("bridge demo:lift __name:=suit");
  WaitForLine(*view, "live: 'skeleton' from ros:/tf");
}

TEST_F(RosSource, KeepsConnectedPublishersDuringAndAfterARestartOfTheMaster) {
  // A node as most are: it registers once, and a restarted master never hears of it.
  const ros::Publisher publisher = node_->advertise<tf2_msgs::TFMessage>("/tf", 10);
  const auto view = Start("serve ros: --http_port 0 --pictures off --ros off __name:=view");
  const std::string page = WaitForLine(*view, "page at ");
  const auto heard = [&] { return SourceAt(page); };
  const auto keep_publishing_until = [&](const auto& condition) {
    return Spin([&] {
      publisher.publish(tf2_msgs::TFMessage());
      return condition(heard());
    });
  };
  ASSERT_TRUE(
      keep_publishing_until([](const auto& source) { return source.value("datagrams", 0) > 0; }));
  master_.reset();
  ASSERT_TRUE(keep_publishing_until(
      [](const auto& source) { return source.at("transport").at("ros_master_answers") == 0; }));
  StartMaster();
  ASSERT_TRUE(keep_publishing_until(
      [](const auto& source) { return source.at("transport").at("ros_master_answers") == 1; }));
  const int before = heard().at("datagrams");
  EXPECT_TRUE(keep_publishing_until(
      [&](const auto& source) { return source.at("datagrams") > before + 5; }));
  EXPECT_EQ(heard().at("transport").at("publishers"), 1);

  // The new master's list has the one that comes now, and nobody else.
  const auto suit = Start("bridge demo:lift --ros required __name:=suit");
  ASSERT_TRUE(keep_publishing_until([](const auto& source) { return source.at("samples") > 10; }));
  const char* ours = "message on /tf without a person's segment";
  const int ours_before = heard().at("ignored").at(ours);
  EXPECT_TRUE(keep_publishing_until([&](const auto& source) {
    return source.at("ignored").at(ours) > ours_before + 20 &&
           source.at("transport").at("publishers") == 2;
  }));
}

TEST_F(RosSource, CountsRejectedMessagesAndContinues) {
  const ros::Publisher publisher = node_->advertise<tf2_msgs::TFMessage>("/people", 100);
  const auto view = Start("serve ros:/people --http_port 0 --pictures off __name:=view");
  const std::string page = WaitForLine(*view, "page at ");
  const auto model = testing::MakeModel();
  const std::int64_t begin = static_cast<std::int64_t>(ros::Time::now().toNSec());
  std::uint32_t n = 0;
  const auto publish = [&](const std::function<void(tf2_msgs::TFMessage&)>& damage) {
    ++n;
    tf2_msgs::TFMessage message;
    const auto person = testing::MakePerson(model, testing::Posture(1e-3 * n), n,
                                            begin + std::int64_t{n} * 1'000'000);
    ros_bridge::FillTransforms(person, ros_bridge::PersonNames(model->human), "world",
                               ros_bridge::TfShape::kFlat, message);
    damage(message);
    publisher.publish(message);
  };
  EXPECT_TRUE(Spin([&] {
    publish([](auto&) {});
    publish([](auto& message) {
      message.transforms[3].transform.translation.y = std::numeric_limits<double>::quiet_NaN();
    });
    publish([](auto& message) { message.transforms[3].transform.rotation.w += 0.1; });
    publish([](auto& message) { message.transforms.erase(message.transforms.begin() + 7); });
    publish([](auto& message) { message.transforms[3].header.frame_id = "elsewhere"; });
    publish([](auto& message) {
      for (auto& transform : message.transforms) transform.header.stamp -= ros::Duration(1);
    });
    publish([](auto& message) { message.transforms.resize(0); });
    const auto now = SourceAt(page);
    const auto rejected = now.value("rejected", nlohmann::json::object());
    return now.value("samples", 0) > 10 && now.value("restarts", 0) > 0 &&
           rejected.contains("transform with a number that is not finite") &&
           rejected.contains("transform with a quaternion that is not of unit length") &&
           rejected.contains("sample without all 23 segments") &&
           rejected.contains("sample whose frames have no common parent") &&
           now.at("ignored").contains("message on /tf without a person's segment");
  })) << SourceAt(page).dump(1);
}

TEST_F(RosSource, RejectsATopicOfAnotherTypeByName) {
  const ros::Publisher publisher = node_->advertise<sensor_msgs::JointState>("/joints", 10);
  const auto view = Start("serve ros:/joints --http_port 0 --pictures off __name:=view");
  const std::string page = WaitForLine(*view, "page at ");
  EXPECT_TRUE(Spin([&] {
    publisher.publish(sensor_msgs::JointState());
    return SourceAt(page).dump().find("message on /joints that is a sensor_msgs/JointState") !=
           std::string::npos;
  }));
}

// Of the topic that Kinescope hears for two reasons. Where it publishes on it, too, roscpp refuses
// such a publisher before any message comes.
TEST_F(RosSource, NamesAPublisherOfAnotherTypeOnTf) {
  const ros::Publisher publisher = node_->advertise<std_msgs::String>("/tf", 10);
  const auto view = Start("serve ros: --tf none --http_port 0 --pictures off __name:=view");
  const std::string page = WaitForLine(*view, "page at ");
  EXPECT_TRUE(Spin([&] {
    publisher.publish(std_msgs::String());
    return SourceAt(page).dump().find("message on /tf that is a std_msgs/String") !=
           std::string::npos;
  })) << SourceAt(page).dump(1);
}

TEST_F(RosSource, HasPeopleWhoseFramesHangOnDifferentOnesInOne) {
  const ros::Publisher statics = node_->advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
  const ros::Publisher publisher = node_->advertise<tf2_msgs::TFMessage>("/tf", 100);
  tf2_msgs::TFMessage labs;
  labs.transforms.resize(2);
  for (std::size_t i = 0; i < 2; ++i) {
    labs.transforms[i].header.frame_id = "world";
    labs.transforms[i].child_frame_id = i == 0 ? "lab_a" : "lab_b";
    labs.transforms[i].transform.translation.y = i == 0 ? 2 : -2;
    labs.transforms[i].transform.rotation.w = 1;
  }
  statics.publish(labs);
  const auto view = Start("serve ros: --http_port 0 --pictures off __name:=view");
  const std::string page = WaitForLine(*view, "page at ");
  const auto anna = testing::MakeModel("anna"), ben = testing::MakeModel("ben");
  const std::int64_t begin = static_cast<std::int64_t>(ros::Time::now().toNSec());
  std::uint32_t n = 0;
  const auto y_of = [&](const std::string& name) {
    const auto text = RunProgram({"/usr/bin/curl", "-sf", page + "api/v1/state"}).out;
    for (const auto& person :
         nlohmann::json::parse(text).value("people", nlohmann::json::array())) {
      if (person["name"] == name && person["com"].is_array()) return person["com"][1].get<double>();
    }
    return std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_TRUE(Spin([&] {
    ++n;
    for (const auto& [model, frame] : {std::pair(anna, "lab_a"), std::pair(ben, "lab_b")}) {
      tf2_msgs::TFMessage message;
      const auto person = testing::MakePerson(model, testing::Posture(1e-3 * n), n,
                                              begin + std::int64_t{n} * 10'000'000);
      ros_bridge::FillTransforms(person, ros_bridge::PersonNames(model->human), frame,
                                 ros_bridge::TfShape::kFlat, message);
      publisher.publish(message);
    }
    return std::abs(y_of("anna") - 2) < 0.5 && std::abs(y_of("ben") + 2) < 0.5;
  })) << y_of("anna")
      << " " << y_of("ben");
}

TEST_F(RosSource, RejectsInvalidNamesAndANameInUse) {
  const auto refusal = [](const std::vector<std::string>& arguments) {
    std::vector<std::string> command = {testing::KinescopePath(), "bridge"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const auto result = RunProgram(command);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    return result.err;
  };
  EXPECT_THAT(refusal({"ros://host:11311"}), HasSubstr("expected ros: or ros:/topic"));
  EXPECT_THAT(refusal({"ros:/kinescope/link_states"}), HasSubstr("__name:="));
  const auto suit = Start("bridge demo:lift --ros required");
  ASSERT_TRUE(Spin([] {
    std::vector<std::string> nodes;
    ros::master::getNodes(nodes);
    return std::count(nodes.begin(), nodes.end(), "/kinescope") == 1;
  }));
  EXPECT_THAT(refusal({"ros:"}), HasSubstr("another running node is already named /kinescope"));
}

TEST_F(RosSource, EndsWhenItsNodeIsKilled) {
  const auto view = Start("bridge ros: --ros off __name:=view");
  const auto is_there = [] {
    std::vector<std::string> nodes;
    ros::master::getNodes(nodes);
    return std::count(nodes.begin(), nodes.end(), "/view") == 1;
  };
  ASSERT_TRUE(Spin(is_there));
  XmlRpc::XmlRpcValue reason("user request");
  Ask("/view", "shutdown", &reason);
  WaitForLine(*view, "stopped by rosnode kill");
  WaitForLine(*view, "stopping");
}

}  // namespace
}  // namespace kinescope
