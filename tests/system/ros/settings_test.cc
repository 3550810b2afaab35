// What may change while the program runs, by the clients that come with dynamic_reconfigure, and
// with a real master.
#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "tests/server/http/test_client.h"
#include "tests/system/ros/ros_fixture.h"
#include "tests/system/run_program.h"

namespace kinescope {
namespace {

using http::testing::Fetch;
using nlohmann::json;
using ::testing::HasSubstr;
using testing::RunProgram;

class SettingsOverRos : public testing::RosProgram {
 protected:
  void StartNode(const std::string& command) {
    setenv("XDG_STATE_HOME", folder_.path().c_str(), 1);
    program_ = Start(command + " demo:lift --ros required --tf off");
    Hear<dynamic_reconfigure::Config>("/kinescope/parameter_updates", [this](const auto& config) {
      for (const auto& number : config.doubles) numbers_[number.name] = number.value;
      for (const auto& text : config.strs) texts_[text.name] = text.value;
    });
  }

  // As a person types it; what the program has then, as it says.
  static std::string Dynparam(const std::vector<std::string>& arguments) {
    std::vector<std::string> command = {KINESCOPE_PYTHON, KINESCOPE_DYNPARAM};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const testing::ProgramResult result = RunProgram(command);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  }

  std::unique_ptr<testing::Process> program_;
  std::map<std::string, double> numbers_;
  std::map<std::string, std::string> texts_;
};

TEST_F(SettingsOverRos, ChangeLimitsPersonAndCameraAndSayWhatThePageChanges) {
  StartNode("serve --http_port 0 --picture_size 320x180");
  const std::string url = WaitForLine(*program_, "page at ");
  const int port = std::stoi(url.substr(url.rfind(':') + 1));
  const auto controls = [&] { return Fetch(port, "/api/v1/controls").json(); };
  ASSERT_TRUE(Spin([&] { return numbers_.count("class_high") != 0; }));
  EXPECT_EQ(numbers_["class_high"], 0.6);
  EXPECT_EQ(texts_["camera"], "three_quarter");

  Dynparam({"set", "/kinescope",
            "{'class_high': 0.8, 'mass': 82.5, 'sex': 'female', 'camera': "
            "'front'}"});
  ASSERT_TRUE(Spin([&] { return controls()["people"][0]["mass_kg"]["value"] == 82.5; }));
  EXPECT_EQ(controls()["people"][0]["sex"]["value"], "female");
  EXPECT_EQ(controls()["class_limits"]["value"], json({0.3, 0.8}));
  const std::string marks = Fetch(port, "/api/v1/marks").json().dump();
  EXPECT_THAT(marks, HasSubstr("class limits: 30 % and 60 % → 30 % and 80 %"));
  EXPECT_THAT(marks, HasSubstr("camera of the server picture: three_quarter → front"));
  EXPECT_THAT(marks, HasSubstr(R"("role":"ros")"));

  const json limits = {{"medium", 0.2}, {"high", 0.5}};
  Fetch(port, "/api/v1/class_limits", {{"Content-Type", "application/json"}}, "POST",
        limits.dump());
  EXPECT_TRUE(Spin([&] { return numbers_["class_high"] == 0.5; }));
  EXPECT_EQ(numbers_["class_medium"], 0.2);
  EXPECT_EQ(numbers_["mass"], 82.5);
}

TEST_F(SettingsOverRos, ChangeTheBridgeAlsoAfterARestartOfTheMasterAndRefuseWhatCannotBe) {
  StartNode("bridge");
  ASSERT_TRUE(Spin([&] { return numbers_.count("mass") != 0; }));
  EXPECT_EQ(texts_.count("camera"), 0u) << "it draws no pictures";
  master_.reset();
  StartMaster();
  ASSERT_TRUE(Spin([&] { return ros::service::exists("/kinescope/set_parameters", false); }));
  Dynparam({"set", "/kinescope", "{'class_medium': 0.7}"});
  EXPECT_THAT(WaitForLine(*program_, "not set over ROS: "), HasSubstr("0.7 is not below 0.6"));
  Dynparam({"set", "/kinescope", "{'class_medium': 0.4, 'mass': 1000}"});
  const std::string now = Dynparam({"get", "/kinescope"});
  EXPECT_THAT(now, HasSubstr("'class_medium': 0.4"));
  EXPECT_THAT(now, HasSubstr("'mass': 300.0")) << "the nearest that may be";
  EXPECT_THAT(WaitForLine(*program_, "ros changed class limits: "), HasSubstr("→ 40 % and 60 %"));
  EXPECT_THAT(WaitForLine(*program_, "ros changed mass of Demo: "), HasSubstr("→ 300 kg"));
}

TEST_F(SettingsOverRos, NameParametersThatAreNoneOrHaveNoValue) {
  ros::param::set("/kinescope/mas", 82.5);
  ros::param::set("/kinescope/tf", false);  // as YAML reads off
  ros::param::set("/kinescope/hand_load", std::map<std::string, double>{{"right", 5}});
  const std::string command = "bridge demo:lift --ros required";
  const auto refused = Start(command);
  EXPECT_THAT(WaitForLine(*refused, "~mas: "), HasSubstr("nearest: mass"));
  EXPECT_THAT(WaitForLine(*refused, "~hand_load: "), HasSubstr("expected one value"));
  EXPECT_EQ(refused->WaitForEnd(), 2);
  ros::param::set("/kinescope/hand_load", "right:5");
  program_ = Start(command);
  WaitForLine(*program_, "live: ");
}

}  // namespace
}  // namespace kinescope
