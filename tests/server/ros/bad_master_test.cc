// A bridge whose master, or whatever has its address, sends answers that no XML-RPC library should
// parse. Each test runs in a process of its own (bridge_fixture.h).
#include "tests/server/ros/bad_master.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>

#include "core/system/errors.h"
#include "tests/server/ros/bridge_fixture.h"

namespace kinescope::ros_bridge {
namespace {

using testing::Answer;
using testing::BadMaster;
using testing::Nested;
using testing::Send;

std::string MasterAnswer(int code, int value) {
  const auto number = [](int n) { return "<value><i4>" + std::to_string(n) + "</i4></value>"; };
  return Answer("<value><array><data>" + number(code) + "<value></value>" + number(value) +
                "</data></array></value>");
}

constexpr char kTooDeep[] = "values nested deeper than 32 levels";

TEST_F(RosBridgeWithMaster, SurvivesAMasterWhoseAnswersAreNestedTooDeep) {
  {
    const BadMaster master(
        [](int connection, const std::string&) { Send(connection, Answer(Nested(80'000))); },
        port_.number());
    MakeBridge();
    EXPECT_TRUE(PublishUntil([&] { return bridge_->status().rejected_calls[kTooDeep] >= 2; }));
    EXPECT_FALSE(bridge_->status().master_reachable);
  }
  StartMaster();
  EXPECT_TRUE(PublishUntil([&] { return bridge_->status().published > 0; }));
}

// The answers that roscpp itself asks for.
TEST_F(RosBridgeWithMaster, SurvivesAMasterThatAnswersRoscppNestedTooDeep) {
  {
    const BadMaster master(
        [](int connection, const std::string& request) {
          const auto is = [&](const char* method) {
            return request.find("<methodName>" + std::string(method) + "<") != std::string::npos;
          };
          if (is("lookupNode")) {
            Send(connection, MasterAnswer(-1, 0));
          } else if (is("getPid")) {
            Send(connection, MasterAnswer(1, 100));
          } else {
            Send(connection, Answer(Nested(80'000)));
          }
        },
        port_.number());
    MakeBridge();
    EXPECT_TRUE(PublishUntil([&] { return bridge_->status().rejected_calls[kTooDeep] >= 2; }));
  }
  StartMaster();
  EXPECT_TRUE(PublishUntil([&] { return bridge_->status().published > 0; }));
}

// roscpp used to end the process then.
TEST_F(RosBridgeWithMaster, SurvivesAMasterThatAnswersRoscppWithOtherTypes) {
  {
    const BadMaster master(
        [](int connection, const std::string& request) {
          const bool is_unknown = request.find("<methodName>lookupNode<") != std::string::npos;
          Send(connection, is_unknown ? MasterAnswer(-1, 0) : MasterAnswer(1, 100));
        },
        port_.number());
    MakeBridge();
    EXPECT_TRUE(PublishUntil([&] {
      const auto rejected = bridge_->status().rejected_calls;
      return rejected.count("answered hasParam with an int instead of a boolean") > 0 &&
             rejected.count(
                 "answered registerSubscriber with an int instead of an array of strings") > 0;
    }));
  }
  StartMaster();
  EXPECT_TRUE(PublishUntil([&] { return bridge_->status().published > 0; }));
}

TEST_F(RosBridgeWithMaster, RequiresAMasterAndNamesAServerThatIsNone) {
  const BadMaster server(
      [](int connection, const std::string&) {
        Send(connection, "HTTP/1.1 404 Not Found\r\nContent-length: 9\r\n\r\nNot Found");
      },
      port_.number());
  try {
    const auto bridge = MakeRosBridge({}, RosMode::kRequired);
    ADD_FAILURE() << "a bridge without a master";
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("does not answer as a ROS master: it answered getPid with something other "
                        "than XML-RPC"),
              std::string::npos)
        << error.what();
  }
}

// As after a packet that the network lost.
TEST_F(RosBridgeWithMaster, RequiresAMasterAndWaitsForOneThatAnswersLate) {
  const BadMaster master(
      [](int connection, const std::string&) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // late is what this is about
        Send(connection, MasterAnswer(1, 100));
      },
      port_.number());
  EXPECT_NO_THROW((void)MakeRosBridge({}, RosMode::kRequired));
}

}  // namespace
}  // namespace kinescope::ros_bridge
