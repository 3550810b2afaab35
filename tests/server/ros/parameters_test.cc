// Parameters and options against a real master: each test runs in a process of its own
// (bridge_fixture.h).
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcServer.h>
#include <xmlrpcpp/XmlRpcServerMethod.h>

#include <atomic>
#include <future>
#include <string>
#include <thread>

#include "core/system/errors.h"
#include "server/ros/master_client.h"
#include "tests/mesh_file_on_demand.h"
#include "tests/server/ros/bridge_fixture.h"
#include "tests/temp_folder.h"

namespace kinescope::ros_bridge {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::MakeModel;
using testing::MakePerson;
using testing::MeshFileOnDemand;
using ::testing::Not;
using testing::Posture;
using testing::SceneWith;
using testing::TempFolder;

// The server of a node, which answers that it runs.
class NodeThatAnswers {
 public:
  NodeThatAnswers() {
    EXPECT_TRUE(server_.bindAndListen(0));
    thread_ = std::thread([this] {
      while (!stops_) server_.work(0.05);
    });
  }
  ~NodeThatAnswers() {
    stops_ = true;
    thread_.join();
    server_.shutdown();
  }
  NodeThatAnswers(const NodeThatAnswers&) = delete;
  NodeThatAnswers& operator=(const NodeThatAnswers&) = delete;

  std::string uri() { return "http://127.0.0.1:" + std::to_string(server_.get_port()) + "/"; }

 private:
  struct GetPid : XmlRpc::XmlRpcServerMethod {
    explicit GetPid(XmlRpc::XmlRpcServer& server) : XmlRpcServerMethod("getPid", &server) {}
    void execute(XmlRpc::XmlRpcValue&, XmlRpc::XmlRpcValue& result) override {
      result[0] = 1;
      result[1] = "";
      result[2] = 4711;
    }
  };
  XmlRpc::XmlRpcServer server_;
  GetPid get_pid_{server_};
  std::atomic<bool> stops_ = false;
  std::thread thread_;
};

TEST_F(RosBridgeWithMaster, PublishesDescriptionsOfAllPeopleAndUpdatesChangedOnes) {
  StartMaster();
  BridgeConfig config;
  config.initial_model = model_;
  MakeBridge(config);
  const auto parameter = [](const std::string& name) {
    XmlRpc::XmlRpcValue arguments;
    arguments[0] = name;
    MasterReply reply = MasterClient().Call("getParam", arguments);
    return reply.code == MasterReply::Code::kGood ? static_cast<std::string>(reply.value)
                                                  : std::string();
  };
  EXPECT_TRUE(Within(kTestPatience, [&] {
    return parameter("/robot_description") == model_->urdf_xml;
  })) << "nobody is there yet: the initial one";

  const TempFolder folder;
  auto anna = std::make_shared<PersonModel>(*MakeModel("anna", 1.6, 7));
  const auto meshes = std::make_shared<MeshFileOnDemand>(folder / "head.stl", "an STL file");
  anna->mesh_files = meshes;
  SceneState state = SceneWith(MakePerson(MakeModel("skeleton", 1.9, 2), Posture(0), 1, 1));
  state.people.push_back(MakePerson(anna, Posture(1), 1, 1));
  state.people[1].character = 3;
  Publish(state);
  EXPECT_TRUE(Within(kTestPatience, [&] {
    return parameter("/robot_description") == state.people[0].model->urdf_xml &&
           parameter("/anna/robot_description") == anna->urdf_xml;
  }));
  EXPECT_TRUE(meshes->is_provided()) << "RViz reads the meshes that robot_description names";

  XmlRpc::XmlRpcValue arguments;
  arguments[0] = "/kinescope";
  MasterReply topics = MasterClient().Call("getPublishedTopics", arguments);
  ASSERT_EQ(topics.code, MasterReply::Code::kGood);
  std::vector<std::string> names;
  for (int i = 0; i < topics.value.size(); ++i) {
    names.push_back(static_cast<std::string>(topics.value[i][0]));
  }
  std::sort(names.begin(), names.end());
  EXPECT_THAT(names, ElementsAre("/kinescope/anna/com", "/kinescope/anna/com_stamped",
                                 "/kinescope/anna/cop", "/kinescope/anna/joint_loads",
                                 "/kinescope/anna/joint_states", "/kinescope/anna/landmarks",
                                 "/kinescope/anna/link_states", "/kinescope/anna/markers",
                                 "/kinescope/anna/time_code", "/kinescope/anna/utc",
                                 "/kinescope/com", "/kinescope/com_stamped", "/kinescope/cop",
                                 "/kinescope/joint_loads", "/kinescope/joint_states",
                                 "/kinescope/landmarks", "/kinescope/link_states",
                                 "/kinescope/markers", "/kinescope/marks", "/kinescope/people",
                                 "/kinescope/state", "/kinescope/time_code", "/kinescope/utc"));
}

class RosBridgeForOtherComputers : public RosBridgeWithMaster {
 protected:
  const char* own_address() const override { return "192.0.2.77"; }
};

TEST_F(RosBridgeForOtherComputers, NamesMeshesAsTheseCanReadThem) {
  StartMaster();
  const TempFolder folder;
  auto anna = std::make_shared<PersonModel>(*MakeModel("anna", 1.6, 7));
  anna->human.mesh_folder = anna->human.tool_folder = folder / "body-7";
  anna->human.tools.set(urdf::kRight);
  const auto meshes = std::make_shared<MeshFileOnDemand>(folder / "head.stl", "an STL file");
  anna->mesh_files = meshes;
  BridgeConfig config;
  config.initial_model = anna;
  std::promise<std::string> offered;
  config.serve_meshes = [&](const std::string& set, const std::shared_ptr<const MeshFiles>& files) {
    offered.set_value(files == meshes ? set : "other files");
    return 4711;
  };
  MakeBridge(config);
  std::future<std::string> set = offered.get_future();
  ASSERT_EQ(set.wait_for(kTestPatience), std::future_status::ready);
  EXPECT_EQ(set.get(), "body-7");
  std::string urdf;
  EXPECT_TRUE(Within(kTestPatience, [&] {
    XmlRpc::XmlRpcValue arguments;
    arguments[0] = "/robot_description";
    MasterReply reply = MasterClient().Call("getParam", arguments);
    if (reply.code != MasterReply::Code::kGood) return false;
    urdf = static_cast<std::string>(reply.value);
    return true;
  }));
  EXPECT_THAT(urdf, HasSubstr("\"http://192.0.2.77:4711/body-7/head.stl\""));
  EXPECT_THAT(urdf, HasSubstr("\"http://192.0.2.77:4711/body-7/right_tool.stl\""));
  EXPECT_THAT(urdf, Not(HasSubstr("file://")));
  EXPECT_FALSE(meshes->is_provided()) << "they are read over HTTP, so there are no files";
}

// Or a robot that is controlled beside the person would lose its model, without a word.
TEST_F(RosBridgeWithMaster, LeavesTheDescriptionOfARobotAsItIs) {
  StartMaster();
  const auto call = [](const char* method, const std::string& name, const std::string& value = "") {
    XmlRpc::XmlRpcValue arguments;
    arguments[0] = name;
    if (!value.empty()) arguments[1] = value;
    MasterReply reply = MasterClient().Call(method, arguments);
    const bool is_text = reply.code == MasterReply::Code::kGood &&
                         reply.value.getType() == XmlRpc::XmlRpcValue::TypeString;
    return is_text ? static_cast<std::string>(reply.value) : std::string();
  };
  const std::string arm = "<robot name=\"arm\"><link name=\"base\"/></robot>";
  call("setParam", "/robot_description", arm);
  call("setParam", "/anna/robot_description", model_->urdf_xml);  // of a Kinescope before
  BridgeConfig config;
  config.initial_model = model_;
  MakeBridge(config);
  EXPECT_TRUE(Within(kTestPatience,
                     [&] { return call("getParam", "/human_description") == model_->urdf_xml; }));
  const auto anna = MakeModel("anna", 1.6, 7);
  SceneState state = SceneWith(MakePerson(MakeModel("skeleton", 1.9, 2), Posture(0), 1, 1));
  state.people.push_back(MakePerson(anna, Posture(1), 1, 1));
  state.people[1].character = 3;
  Publish(state);
  EXPECT_TRUE(Within(kTestPatience, [&] {
    return call("getParam", "/human_description") == state.people[0].model->urdf_xml &&
           call("getParam", "/anna/robot_description") == anna->urdf_xml;
  }));
  EXPECT_EQ(call("getParam", "/robot_description"), arm);
}

TEST_F(RosBridgeWithMaster, GivesUpTheDescriptionOfARobotThatIsStartedLater) {
  StartMaster();
  BridgeConfig config;
  config.initial_model = model_;
  MakeBridge(config);
  const auto parameter = [](const char* method, const std::string& name, const char* value) {
    XmlRpc::XmlRpcValue arguments;
    arguments[0] = name;
    if (value != nullptr) arguments[1] = std::string(value);
    MasterReply reply = MasterClient().Call(method, arguments);
    const bool is_text = reply.value.getType() == XmlRpc::XmlRpcValue::TypeString;
    return is_text ? static_cast<std::string>(reply.value) : std::string();
  };
  const auto get = [&](const std::string& name) { return parameter("getParam", name, nullptr); };
  ASSERT_TRUE(Within(kTestPatience, [&] { return get("/robot_description") == model_->urdf_xml; }));
  const char arm[] = "<robot name=\"arm\"><link name=\"base\"/></robot>";
  parameter("setParam", "/robot_description", arm);
  EXPECT_TRUE(Within(kTestPatience, [&] { return get("/human_description") == model_->urdf_xml; }));
  const SceneState state = SceneWith(MakePerson(MakeModel("skeleton", 1.9, 2), Posture(0), 1, 1));
  Publish(state);
  EXPECT_TRUE(Within(kTestPatience,
                     [&] { return get("/human_description") == state.people[0].model->urdf_xml; }));
  EXPECT_EQ(get("/robot_description"), arm);
}

TEST_F(RosBridgeWithMaster, LeavesTheDescriptionOfAnotherKinescopeAsItIs) {
  StartMaster();
  const auto call = [](const char* method, XmlRpc::XmlRpcValue arguments) {
    return MasterClient().Call(method, arguments).value;
  };
  // What a bridge called /suit tells the master, and one of its topics.
  XmlRpc::XmlRpcValue description, published, topic, answer;
  description[0] = "/robot_description";
  description[1] = model_->urdf_xml + " ";
  published[0] = "/suit/published";
  published[1]["reference_frame"] = "world";
  published[1]["people"][0]["model"] = "skeleton";
  published[1]["people"][0]["description"] = "/robot_description";
  published[1]["people"][0]["topics"] = "/suit/";
  topic[0] = "/suit";
  topic[1] = "/suit/joint_loads";
  topic[2] = "kinescope/JointLoadArray";
  NodeThatAnswers node;
  topic[3] = node.uri();
  call("setParam", description);
  call("setParam", published);
  XmlRpc::XmlRpcClient suit("127.0.0.1", port_.number());  // by its own name
  ASSERT_TRUE(suit.execute("registerPublisher", topic, answer));
  BridgeConfig config;
  config.initial_model = model_;
  MakeBridge(config);
  const auto get = [&](const char* name) {
    XmlRpc::XmlRpcValue arguments;
    arguments[0] = name;
    const XmlRpc::XmlRpcValue value = call("getParam", arguments);
    return value.getType() == XmlRpc::XmlRpcValue::TypeString ? std::string(value) : "";
  };
  EXPECT_TRUE(Within(kTestPatience, [&] { return get("/human_description") == model_->urdf_xml; }));
  EXPECT_EQ(get("/robot_description"), model_->urdf_xml + " ");
}

TEST_F(RosBridgeWithMaster, WritesTheDescriptionWhereItIsTold) {
  StartMaster();
  BridgeConfig config;
  config.initial_model = model_;
  config.description = "/lab/person";
  MakeBridge(config);
  EXPECT_TRUE(Within(kTestPatience, [&] {
    XmlRpc::XmlRpcValue arguments;
    arguments[0] = "/lab/person";
    MasterReply reply = MasterClient().Call("getParam", arguments);
    return reply.code == MasterReply::Code::kGood &&
           static_cast<std::string>(reply.value) == model_->urdf_xml;
  }));
}

// A sender may change the body with every sample; each one that is described has its meshes
// written.
TEST_F(RosBridgeWithMaster, WritesTheMeshesOfAtMostOneBodyPerSecond) {
  StartMaster();
  MakeBridge();
  const TempFolder folder;
  const auto parameter = [] {
    XmlRpc::XmlRpcValue arguments;
    arguments[0] = "/robot_description";
    MasterReply reply = MasterClient().Call("getParam", arguments);
    return reply.code == MasterReply::Code::kGood ? static_cast<std::string>(reply.value)
                                                  : std::string();
  };
  const auto start = Clock::now();
  std::vector<std::shared_ptr<MeshFileOnDemand>> meshes;
  std::string newest;
  for (int i = 0; i < 50; ++i) {
    auto model = std::make_shared<PersonModel>(*MakeModel("skeleton", 1.5 + 0.01 * i, i + 1));
    meshes.push_back(std::make_shared<MeshFileOnDemand>(folder / "head.stl", "an STL file"));
    model->mesh_files = meshes.back();
    newest = model->urdf_xml;
    Publish(SceneWith(MakePerson(model, Posture(0), 1, 1)));
    parameter();  // the bridge has the time of a call, too
  }
  EXPECT_TRUE(Within(kTestPatience, [&] { return parameter() == newest; }));
  const auto written = std::count_if(meshes.begin(), meshes.end(),
                                     [](const auto& each) { return each->is_provided(); });
  const double secs = std::chrono::duration<double>(Clock::now() - start).count();
  EXPECT_LE(written, 2 + secs);
  EXPECT_TRUE(meshes.back()->is_provided());
}

// "" if there is none.
std::string ParameterText(const std::string& name) {
  const auto found = PrivateParameters().find(name);
  return found == PrivateParameters().end()
             ? ""
             : fmt::format("{}", fmt::join(found->second.texts, ";"));
}

TEST_F(RosBridgeWithMaster, ReadsPrivateParametersOfAnyTypeAndPrefersTheCommandLine) {
  EXPECT_THAT(remaining_, ElementsAre("test", "left", "right"));
  StartMaster();
  const auto set = [](const std::string& name, const XmlRpc::XmlRpcValue& value) {
    XmlRpc::XmlRpcValue arguments;
    arguments[0] = "/kinescope/" + name;
    arguments[1] = value;
    ASSERT_EQ(MasterClient().Call("setParam", arguments).code, MasterReply::Code::kGood);
  };
  set("udp_port", 9763);
  set("rate", 2.5);
  set("model_name", std::string("anna"));
  set("rviz", XmlRpc::XmlRpcValue(true));
  XmlRpc::XmlRpcValue list;
  list[0] = 1;
  list[1] = std::string("two");
  set("list", list);
  XmlRpc::XmlRpcValue map;
  map["right"] = 5;
  set("map", map);
  list[2] = map;
  set("list_of_maps", list);
  EXPECT_EQ(ParameterText("udp_port"), "8001") << "_udp_port:=8001 was on the command line";
  EXPECT_EQ(ParameterText("rate"), "2.5");
  EXPECT_EQ(ParameterText("model_name"), "anna");
  EXPECT_EQ(ParameterText("rviz"), "true");
  EXPECT_EQ(ParameterText("list"), "1;two");
  EXPECT_EQ(ParameterText("never_set"), "");
  const auto kind_of = [](const char* name) { return PrivateParameters().at(name).kind; };
  EXPECT_EQ(kind_of("rate"), NodeParameter::Kind::kText);
  EXPECT_EQ(kind_of("rviz"), NodeParameter::Kind::kSwitch);
  EXPECT_EQ(kind_of("list"), NodeParameter::Kind::kList);
  EXPECT_EQ(kind_of("map"), NodeParameter::Kind::kOther);
  EXPECT_EQ(kind_of("list_of_maps"), NodeParameter::Kind::kOther);

  MakeBridge();  // shows the arguments to `rosparam get`
  XmlRpc::XmlRpcValue arguments;
  arguments[0] = "/kinescope/udp_port";
  EXPECT_TRUE(Within(kTestPatience, [&] {
    MasterReply reply = MasterClient().Call("getParam", arguments);
    return reply.code == MasterReply::Code::kGood && static_cast<int>(reply.value) == 8001;
  }));
}

TEST_F(RosBridgeWithMaster, ReadsTheCommandLineWithoutAMaster) {
  EXPECT_EQ(ParameterText("tf"), "tree");
  EXPECT_EQ(ParameterText("never_set"), "");
  EXPECT_THROW((void)MakeRosBridge({}, RosMode::kRequired), UsageError);
  EXPECT_EQ(MakeRosBridge({}, RosMode::kOff), nullptr);
}

TEST_F(RosBridgeWithMaster, RejectsAnInvalidConfiguration) {
  BridgeConfig config;
  config.tf = "sideways";
  EXPECT_THROW((void)MakeRosBridge(config, RosMode::kAuto), UsageError);
  config = {};
  config.joint_states = "guessed";
  EXPECT_THROW((void)MakeRosBridge(config, RosMode::kAuto), UsageError);
  config = {};
  config.reference_frame = "/world";
  EXPECT_THROW((void)MakeRosBridge(config, RosMode::kAuto), UsageError);
}

}  // namespace
}  // namespace kinescope::ros_bridge
