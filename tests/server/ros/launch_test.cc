// What a launch file started, seen from outside: the topics, TF and description of one person.
//   launch_test <node name> [<bag> | rviz]    started by rostest, see *.test beside this file
// <bag>: what record.launch writes, without date and ending. rviz: rviz.launch shows the node.
#include <geometry_msgs/Point.h>
#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>
#include <urdf/model.h>
#include <visualization_msgs/MarkerArray.h>
#include <xsens_mvn_ros_msgs/LinkStateArray.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace {

std::string g_node;       // set once by main
std::string g_what_else;  // the second argument; set once by main

// The next message, or null with a failed expectation.
template <class Message>
boost::shared_ptr<const Message> Next(const std::string& topic) {
  auto message = ros::topic::waitForMessage<Message>(topic, ros::Duration(60));
  EXPECT_NE(message, nullptr) << "nothing comes on " << topic;
  return message;
}

TEST(LaunchFile, PublishesTheJointsOfThePerson) {
  const auto message = Next<sensor_msgs::JointState>(g_node + "/joint_states");
  ASSERT_NE(message, nullptr);
  EXPECT_EQ(message->position.size(), 66U);
  ASSERT_EQ(message->name.size(), 66U);
  EXPECT_EQ(message->name.front(), "skeleton_c1_head_x");
  EXPECT_EQ(message->name.back(), "skeleton_t9_t8_z");
}

TEST(LaunchFile, PublishesTheLinksOfThePerson) {
  const auto message = Next<xsens_mvn_ros_msgs::LinkStateArray>(g_node + "/link_states");
  ASSERT_NE(message, nullptr);
  ASSERT_EQ(message->states.size(), 23U);
  EXPECT_EQ(message->states.front().header.frame_id, "head");
  const double head = message->states.front().pose.position.z;
  EXPECT_GT(head, 0.3);
  EXPECT_LT(head, 2.5);
}

TEST(LaunchFile, PublishesCentresOfMassAndPressure) {
  const auto point = Next<geometry_msgs::Point>(g_node + "/com");
  ASSERT_NE(point, nullptr);
  EXPECT_GT(point->z, 0.2);
  const auto com = Next<geometry_msgs::PointStamped>(g_node + "/com_stamped");
  ASSERT_NE(com, nullptr);
  EXPECT_EQ(com->header.frame_id, "world");
  const auto cop = Next<geometry_msgs::PointStamped>(g_node + "/cop");
  ASSERT_NE(cop, nullptr);
  EXPECT_NEAR(cop->point.z, 0, 0.05);
}

TEST(LaunchFile, PublishesALoadSphereForEveryScoredJoint) {
  const auto message = Next<visualization_msgs::MarkerArray>(g_node + "/markers");
  ASSERT_NE(message, nullptr);
  int spheres = 0;
  for (const auto& marker : message->markers) spheres += marker.ns == "loads" ? 1 : 0;
  EXPECT_GE(spheres, 8);
}

TEST(LaunchFile, PublishesAFrameForEveryLinkOfTheDescription) {
  const auto message = Next<tf2_msgs::TFMessage>("/tf");
  ASSERT_NE(message, nullptr);
  std::set<std::string> frames;
  for (const auto& one : message->transforms) {
    EXPECT_EQ(one.header.frame_id, "world");
    frames.insert(one.child_frame_id);
  }
  std::string description;
  const auto deadline = ros::WallTime::now() + ros::WallDuration(60);
  while (!ros::param::get("robot_description", description)) {  // may come after the topics
    ASSERT_LT(ros::WallTime::now(), deadline) << "no robot_description";
  }
  urdf::Model model;
  ASSERT_TRUE(model.initString(description));
  EXPECT_EQ(model.getRoot()->name, "skeleton_pelvis");
  EXPECT_EQ(frames.size(), model.links_.size());
  for (const auto& [name, link] : model.links_) EXPECT_EQ(frames.count(name), 1U) << name;
}

TEST(LaunchFile, RecordsWhatIsPublished) {
  if (g_what_else.empty() || g_what_else == "rviz") GTEST_SKIP() << "not this launch file";
  const std::filesystem::path bag = g_what_else;
  const auto deadline = ros::WallTime::now() + ros::WallDuration(60);
  std::uintmax_t bytes = 0;
  while (bytes < 100'000 && ros::WallTime::now() < deadline) {
    std::error_code gone;  // rosbag renames it
    for (const auto& file : std::filesystem::directory_iterator(bag.parent_path(), gone)) {
      const bool is_it = file.path().filename().string().rfind(bag.filename().string(), 0) == 0;
      if (is_it) bytes = std::filesystem::file_size(file.path(), gone);
    }
  }
  EXPECT_GE(bytes, 100'000U) << "rosbag writes nothing to " << bag << "*.bag";
}

TEST(LaunchFile, ShowsThePersonInRviz) {
  if (g_what_else != "rviz") GTEST_SKIP() << "not this launch file";
  const auto listens = [](const std::string& topic) {
    XmlRpc::XmlRpcValue name, reply, state;
    name[0] = "/launch_test";
    if (!ros::master::execute("getSystemState", name, reply, state, true)) return false;
    for (int i = 0; i < state[1].size(); ++i) {
      for (int j = 0; j < state[1][i][1].size(); ++j) {
        const std::string of_topic = state[1][i][0], by = state[1][i][1][j];
        if (of_topic == topic && by.rfind("/lab/rviz", 0) == 0) return true;
      }
    }
    return false;
  };
  const auto deadline = ros::WallTime::now() + ros::WallDuration(60);
  while (!listens(g_node + "/markers") && ros::WallTime::now() < deadline) {
    ros::WallDuration(0.05).sleep();  // another process's progress: there is nothing to wait on
  }
  EXPECT_TRUE(listens(g_node + "/markers"));
  EXPECT_TRUE(listens("/tf"));
}

// What RViz reports of a display: "Status: Ok" and lines such as "skeleton_pelvis: Transform OK".
using Statuses = std::map<std::string, std::vector<std::string>>;

Statuses ReportedByRviz() {
  Statuses statuses;
  XmlRpc::XmlRpcValue all;
  if (!ros::param::get("/rviz_statuses", all)) return statuses;
  for (auto& [display, lines] : all) {
    for (int i = 0; i < lines.size(); ++i) statuses[display].push_back(lines[i]);
  }
  return statuses;
}

std::string NotOk(const Statuses& statuses) {
  std::string text;
  for (const auto& [display, lines] : statuses) {
    if (lines.front().find("Status: Ok") != std::string::npos) continue;
    text += display + ":\n";
    for (const std::string& line : lines) text += "  " + line + "\n";
  }
  return text;
}

// RViz has given up a marker, and then found that it has the transform: its own thread of TF was
// late, as on a busy machine. Of a transform that we do not send it tells another reason.
bool IsOfALateRviz(const std::string& not_ok) {
  return not_ok.find("Unknown reason for transform failure") != std::string::npos;
}

TEST(LaunchFile, IsShownByRvizWithoutAWarningOrAnError) {
  if (g_what_else != "rviz") GTEST_SKIP() << "not this launch file";
  const auto deadline = ros::WallTime::now() + ros::WallDuration(60);
  Statuses seen;
  const auto has_all = [&] {
    seen = ReportedByRviz();
    for (const char* display : {"root", "Floor", "Body of skeleton", "Loads of skeleton"}) {
      if (seen.count(display) == 0) return false;
    }
    return NotOk(seen).empty();
  };
  while (!has_all() && ros::WallTime::now() < deadline) {
    ros::WallDuration(0.05).sleep();  // another process's progress: there is nothing to wait on
  }
  std::string shown;
  for (const auto& [display, lines] : seen) shown += display + ", ";
  ASSERT_TRUE(has_all()) << "RViz shows " << shown << "\n" << NotOk(seen);
  EXPECT_GE(seen.at("Body of skeleton").size(), 24U) << "a line for each link that has a shape";

  constexpr int kEnough = 12;  // reports in which all is well; one in which it is not ends the test
  int good = 0, former = 0, report = 0;
  const auto end = ros::WallTime::now() + ros::WallDuration(60);
  std::string not_ok;
  while (good < kEnough && ros::WallTime::now() < end) {
    ros::param::get("/rviz_reports", report);
    if (std::exchange(former, report) != report) {
      not_ok = NotOk(ReportedByRviz());
      ASSERT_TRUE(not_ok.empty() || IsOfALateRviz(not_ok)) << "it does not stay so:\n" << not_ok;
      good += not_ok.empty() ? 1 : 0;
    }
    ros::WallDuration(0.05).sleep();  // another process's progress: there is nothing to wait on
  }
  EXPECT_EQ(good, kEnough) << "of " << former << " reports of RViz, the last:\n" << not_ok;
}

}  // namespace

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "launch_test", ros::init_options::AnonymousName);
  if (argc < 2 || argc > 3) return 2;
  g_node = argv[1];
  if (argc == 3) g_what_else = argv[2];
  const ros::NodeHandle node;  // keeps roscpp up between the tests
  return RUN_ALL_TESTS();
}
