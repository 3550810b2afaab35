// Diagnostics, alarms and marks over ROS, with everything real: a master, `kinescope serve`, and
// this test as the one who listens and marks.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PointStamped.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <kinescope/Mark.h>
#include <kinescope/SetHandLoad.h>
#include <rosgraph_msgs/Log.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/server/http/test_client.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/ros/ros_fixture.h"
#include "tests/system/run_program.h"

namespace kinescope {
namespace {

using http::testing::Fetch;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class NewsOverRos : public testing::RosProgram {
 protected:
  void StartServe(const std::string& options) {
    setenv("XDG_STATE_HOME", folder_.path().c_str(), 1);
    program_ =
        Start("serve demo:lift --ros required --http_port 0 --pictures off --tf off " + options);
    const std::string url = WaitForLine(*program_, "page at ");
    const std::size_t colon = url.rfind(':');
    ASSERT_NE(colon, std::string::npos) << url;
    port_ = std::stoi(url.substr(colon + 1));
  }
  void HearDiagnostics() {
    Hear<diagnostic_msgs::DiagnosticArray>("/diagnostics",
                                           [this](const diagnostic_msgs::DiagnosticArray& message) {
                                             for (const auto& status : message.status)
                                               diagnoses_[status.name] = status;
                                           });
  }
  json Post(const std::string& target, const json& body) const {
    return Fetch(port_, target, {{"Content-Type", "application/json"}}, "POST", body.dump()).json();
  }

  std::unique_ptr<testing::Process> program_;
  int port_ = 0;
  std::map<std::string, diagnostic_msgs::DiagnosticStatus> diagnoses_;  // by name
};

TEST_F(NewsOverRos, DiagnosticsSayHowTheStreamIsAndWhichAlarmsAreOn) {
  const std::string rules = (folder_ / "rules.yaml").string();
  std::ofstream(rules) << "rules:\n"
                          "  - {name: always, value: compression, above: 0, priority: high}\n"
                          "  - {name: never, value: compression, above: 50000}\n";
  StartServe("--alarms " + rules);
  HearDiagnostics();
  ASSERT_TRUE(Spin([&] { return diagnoses_["kinescope: alarm always"].level == 2; }));
  EXPECT_THAT(diagnoses_["kinescope: alarm always"].message, HasSubstr("L5/S1 compression"));
  EXPECT_EQ(diagnoses_["kinescope: alarm never"].level, 0);
  EXPECT_EQ(diagnoses_["kinescope: alarm never"].message, "no alarm");
  EXPECT_EQ(diagnoses_["kinescope: alarm lost"].level, 0);
  ASSERT_TRUE(Spin([&] { return diagnoses_["kinescope: stream"].level == 0; }));
  EXPECT_THAT(diagnoses_["kinescope: stream"].message, HasSubstr("live, "));
  ASSERT_TRUE(Spin([&] {
    return diagnoses_["kinescope: frequency"].message == "Desired frequency met";
  })) << diagnoses_["kinescope: frequency"].message;
  double target = 0;
  for (const auto& entry : diagnoses_["kinescope: frequency"].values) {
    if (entry.key == "Target frequency (Hz)") target = std::stod(entry.value);
  }
  EXPECT_NEAR(target, 120, 12);
  EXPECT_EQ(diagnoses_["kinescope: time stamps"].level, 0);
  EXPECT_EQ(Post("/api/v1/acknowledge", {{"id", 1}})["acknowledged"]["role"], "operator");
  EXPECT_TRUE(Spin([&] {
    const auto& values = diagnoses_["kinescope: alarm always"].values;
    return !values.empty() && values[0].value.rfind("acknowledged: ", 0) == 0;
  }));
}

TEST_F(NewsOverRos, MarksComeFromRosAndAreHeardThere) {
  StartServe("");
  std::vector<kinescope_ros::Mark> heard;
  Hear<kinescope_ros::Mark>("/kinescope/marks",
                            [&](const kinescope_ros::Mark& mark) { heard.push_back(mark); });
  ros::Publisher out = node_->advertise<std_msgs::String>("/kinescope/mark", 10);
  ASSERT_TRUE(Spin([&] {
    return out.getNumSubscribers() > 0 && subscribers_.front().getNumPublishers() > 0 &&
           Fetch(port_, "/api/v1/state").json()["liveness"] == "live";
  }));
  const auto mark = [&](const std::string& text) {
    std_msgs::String message;
    message.data = text;
    out.publish(message);
  };
  for (const std::string& text : {std::string("belt <b>slipped</b>"), std::string(" "),
                                  std::string(300, 'x'), std::string("2")}) {
    mark(text);
  }
  ASSERT_TRUE(Spin([&] { return heard.size() == 2; })) << heard.size();
  EXPECT_EQ(heard[0].text, "belt <b>slipped</b>");
  EXPECT_EQ(heard[0].button, 0);
  EXPECT_EQ(heard[0].role, "ros");
  EXPECT_FALSE(heard[0].is_span);
  EXPECT_EQ(heard[1].text, "lift") << "the name of button 2";
  EXPECT_EQ(heard[1].button, 2);
  const json kept = Fetch(port_, "/api/v1/marks").json()["marks"];
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0]["at"]["counter"], heard[0].counter);
  EXPECT_EQ(kept[0]["at"]["stamp_micros"], heard[0].header.stamp.toNSec() / 1000);
  Post("/api/v1/mark", {{"id", heard[0].id}, {"remove", true}});
  ASSERT_TRUE(Spin([&] { return heard.size() == 3; }));
  EXPECT_TRUE(heard[2].is_removed);
  EXPECT_EQ(heard[2].id, heard[0].id);
  kinescope_ros::SetHandLoad order;
  order.request.right_kg = 5;
  ASSERT_TRUE(ros::service::call("/kinescope/set_hand_load", order));
  ASSERT_TRUE(Spin([&] { return heard.size() == 4; })) << "who changed what is a mark";
  EXPECT_EQ(heard[3].text, "hand load of Demo: unknown → 5 kg right");
  EXPECT_EQ(heard[3].role, "ros");
}

TEST_F(NewsOverRos, WarnsOfASecondNodeWithTheSameFrames) {
  const auto first = Start("bridge demo:lift --ros required __name:=one");
  WaitForParameter("/one/published/reference_frame");
  const auto monitor = Start("bridge demo:lift --ros required --tf none __name:=two");
  WaitForParameter("/two/published/reference_frame");
  const auto second = Start("bridge demo:walk --ros required __name:=three");
  EXPECT_THAT(WaitForLine(*second, "the node "),
              AllOf(HasSubstr("/one publishes the frames of a person called skeleton"),
                    HasSubstr("--model_name")));
  const auto inspect = Start("inspect ros: --seconds 20 __name:=four");
  EXPECT_THAT(WaitForLine(*inspect, "two nodes, "),
              AllOf(HasSubstr("/one"), HasSubstr("/three"), HasSubstr("--model_name")));
}

TEST_F(NewsOverRos, SaysWhichNodeEndsBecauseOfItsName) {
  const auto first = Start("bridge demo:lift --ros required __name:=one");
  WaitForParameter("/one/published/reference_frame");
  const auto second = Start("bridge demo:walk --ros required __name:=one");
  EXPECT_THAT(WaitForLine(*second, "another node is named /one"), HasSubstr("__name:="));
  WaitForLine(*first, "another node with the same name");
}

// The master still has its topics and its parameters.
TEST_F(NewsOverRos, DoesNotCountANodeThatWasKilled) {
  const auto killed = Start("bridge demo:lift --ros required __name:=one");
  WaitForParameter("/one/published/reference_frame");
  const auto config = [&] {
    return testing::RunProgram({testing::KinescopePath(), "rviz", "--out", folder_ / "a.rviz"});
  };
  EXPECT_EQ(config().exit_code, 0);
  killed->Signal(SIGKILL);
  killed->WaitForEnd();
  EXPECT_NE(config().exit_code, 0) << "nothing to see";
  const auto running = Start("bridge demo:lift --ros required __name:=two");
  WaitForParameter("/two/published/reference_frame");
  const testing::ProgramResult only = config();
  EXPECT_EQ(only.exit_code, 0) << only.out << only.err;
}

TEST_F(NewsOverRos, SaysWhatIsNotShownOfTheGraph) {
  ros::Publisher walls = node_->advertise<visualization_msgs::Marker>("/walls", 1, true);
  visualization_msgs::Marker wall;
  wall.ns = "walls";
  wall.pose.orientation.w = std::numeric_limits<double>::quiet_NaN();
  ros::param::set("/number", 42);
  const auto server = Start(
      "serve demo:lift --ros required --http_port 0 --pictures off --marker_topics /wolls,/walls "
      "--robot ros:panda --robot ros:number");
  const std::string page = WaitForLine(*server, "page at ");
  ASSERT_TRUE(Spin([&] { return walls.getNumSubscribers() > 0; }));
  walls.publish(wall);
  WaitForLine(*server, "/walls: marker walls/0: ");
  wall.header.frame_id = "lidar";
  wall.pose.orientation.w = 1;
  wall.type = visualization_msgs::Marker::CUBE;
  wall.scale.x = wall.scale.y = wall.scale.z = wall.color.a = 1;
  walls.publish(wall);
  WaitForLine(*server, "no publisher of /wolls (--marker_topics)");
  WaitForLine(*server, "/panda: the parameter is not set");
  const auto diagnostics = [&] {
    const auto answer =
        testing::RunProgram({"/usr/bin/curl", "-sf", page + "api/v1/diagnostics"}).out;
    return nlohmann::json::parse(answer)["ros"];
  };
  EXPECT_EQ(diagnostics()["inputs"]["robot /number"]["last_problem"],
            "the parameter is no text; expected a URDF");
  const auto not_shown = [&] { return diagnostics()["not_shown"]; };
  const std::string wolls = "/wolls: no node publishes it";
  const std::string lidar = "/walls: marker walls/0: frame 'lidar' is not known yet";
  EXPECT_TRUE(Spin([&] { return not_shown() == nlohmann::json{wolls, lidar}; })) << not_shown();
  tf2_msgs::TFMessage place;
  place.transforms.resize(1);
  place.transforms[0].header.frame_id = "world";
  place.transforms[0].child_frame_id = "lidar";
  place.transforms[0].transform.rotation.w = std::numeric_limits<double>::quiet_NaN();
  const ros::Publisher moving = node_->advertise<tf2_msgs::TFMessage>("/tf", 1, true);
  moving.publish(place);
  WaitForLine(*server, "/tf: a transform with a number that is not finite: 'lidar' in 'world'");
  place.transforms[0].transform.rotation.w = 1;
  const ros::Publisher places = node_->advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
  places.publish(place);
  EXPECT_TRUE(Spin([&] { return not_shown() == nlohmann::json{wolls}; })) << not_shown();
}

// roscpp turns a publisher of another type than the first away.
TEST_F(NewsOverRos, ShowsATopicThatHasAnotherTypeNow) {
  ros::Publisher thing = node_->advertise<visualization_msgs::Marker>("/thing", 1, true);
  visualization_msgs::Marker wall;
  wall.ns = "walls";
  wall.pose.orientation.w = 1;
  wall.type = visualization_msgs::Marker::CUBE;
  wall.scale.x = wall.scale.y = wall.scale.z = wall.color.a = 1;
  thing.publish(wall);
  const auto server =
      Start("serve demo:n_pose --ros required --http_port 0 --pictures off --marker_topics /thing");
  const std::string page = WaitForLine(*server, "page at ");
  const auto shown = [&] {  // how large it is
    return testing::RunProgram({"/usr/bin/curl", "-sf", page + "api/v1/surroundings.glb"})
        .out.size();
  };
  ASSERT_TRUE(Spin([&] { return shown() > 0; }));
  const std::size_t of_wall = shown();
  thing.shutdown();
  thing = node_->advertise<geometry_msgs::PointStamped>("/thing", 1, true);
  WaitForLine(*server,
              "/thing has another type now: geometry_msgs/PointStamped, formerly "
              "visualization_msgs/Marker");
  EXPECT_TRUE(Spin([&] { return shown() < of_wall; })) << "what was there is still shown";
  thing.publish(geometry_msgs::PointStamped());
  EXPECT_TRUE(Spin([&] { return shown() > of_wall; })) << "a sphere has more triangles";
}

TEST_F(NewsOverRos, SaysWhetherTheStreamIsLiveAlsoToThoseWhoComeLater) {
  const auto bridge = Start("bridge udp://127.0.0.1:0 --ros required");
  const std::string suit_address = WaitForAddress(*bridge);
  std::vector<std::string> states, lines;
  const auto has = [&](const char* state) { return !states.empty() && states.back() == state; };
  const auto hear = [&] {
    Hear<std_msgs::String>("/kinescope/state",
                           [&](const std_msgs::String& state) { states.push_back(state.data); });
  };
  hear();
  visualization_msgs::MarkerArray markers;
  Hear<visualization_msgs::MarkerArray>("/kinescope/markers",
                                        [&](const auto& message) { markers = message; });
  Hear<rosgraph_msgs::Log>("/rosout", [&](const rosgraph_msgs::Log& line) {
    if (line.name == "/kinescope") lines.push_back(line.msg);
  });
  ASSERT_TRUE(Spin([&] { return has("no data"); }));
  auto suit = Start("stream demo:t_pose --to " + suit_address);
  ASSERT_TRUE(Spin([&] { return has("live"); }));
  const auto are_all = [&](int action) {
    return !markers.markers.empty() &&
           std::all_of(markers.markers.begin(), markers.markers.end(),
                       [&](const auto& marker) { return marker.action == action; });
  };
  ASSERT_TRUE(Spin([&] { return are_all(visualization_msgs::Marker::ADD); }));
  suit.reset();
  ASSERT_TRUE(Spin([&] { return has("lost"); }));
  EXPECT_TRUE(Spin([&] { return are_all(visualization_msgs::Marker::DELETE); }))
      << "who shows them must not keep loads of somebody who is gone";
  EXPECT_THAT(states, ElementsAre("no data", "live", "stale", "lost"));
  states.clear();
  subscribers_.erase(subscribers_.begin());
  hear();
  EXPECT_TRUE(Spin([&] { return has("lost"); })) << "the topic is latched";
  EXPECT_TRUE(Spin([&] {
    return std::any_of(lines.begin(), lines.end(), [](const std::string& line) {
      return line.find("waiting for data from ") != std::string::npos;
    });
  })) << "the log also has what was written before it could be published";
}

}  // namespace
}  // namespace kinescope
