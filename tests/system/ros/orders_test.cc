// What other nodes order of `kinescope serve`: a snapshot, a recording; with a real master, a suit
// over UDP and a renderer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "render/image/png_file.h"
#include "tests/system/ros/ros_fixture.h"

namespace kinescope {
namespace {

using ::testing::HasSubstr;

class OrdersOverRos : public testing::RosProgram {
 protected:
  void StartServe(const std::string& options) {
    setenv("XDG_STATE_HOME", folder_.path().c_str(), 1);
    program_ = Start("serve udp://127.0.0.1:0 --ros required --http_port 0 --recordings_folder " +
                     folder_.path().string() + " --marks_file " +
                     (folder_ / "marks.jsonl").string() + " " + options);
    const std::string address = WaitForAddress(*program_);
    suit_ = Start("stream demo:lift --to " + address);
    WaitForLine(*program_, "live: ");
  }

  template <class Service>
  typename Service::Response Call(const std::string& name, typename Service::Request request = {}) {
    typename Service::Response response;
    ros::ServiceClient client = node_->serviceClient<Service>("/kinescope/" + name);
    EXPECT_TRUE(Spin([&] { return client.exists(); })) << name;
    EXPECT_TRUE(client.call(request, response)) << name;
    return response;
  }

  std_srvs::SetBool::Response Record(bool run) {
    std_srvs::SetBool::Request request;
    request.data = run;
    return Call<std_srvs::SetBool>("record", request);
  }

  std::unique_ptr<testing::Process> program_, suit_;
};

TEST_F(OrdersOverRos, MakeASnapshotInTheFolderOfRecordingsAlsoAfterARestartOfTheMaster) {
  StartServe("--picture_size 320x180");
  const auto first = Call<std_srvs::Trigger>("snapshot");
  ASSERT_TRUE(first.success) << first.message;
  EXPECT_THAT(first.message, HasSubstr((folder_ / "snapshot_").string()));
  const render::Image image = render::ReadPng(first.message);
  EXPECT_EQ(image.width, 1280);
  EXPECT_EQ(image.height, 720);
  master_.reset();
  StartMaster();
  const auto second = Call<std_srvs::Trigger>("snapshot");
  EXPECT_TRUE(second.success) << second.message;
  EXPECT_NE(second.message, first.message);
}

TEST_F(OrdersOverRos, MakeNoSnapshotOfNothing) {
  program_ = Start("serve udp://127.0.0.1:0 --ros required --http_port 0 --recordings_folder " +
                   folder_.path().string());
  WaitForLine(*program_, "page at ");
  std_srvs::Trigger::Response answer;
  ASSERT_TRUE(Spin([&] {  // the page is there a little earlier than the orders
    answer = Call<std_srvs::Trigger>("snapshot");
    return answer.message.find("is starting") == std::string::npos;
  }));
  EXPECT_FALSE(answer.success);
  EXPECT_THAT(answer.message, HasSubstr("no sample yet"));
}

TEST_F(OrdersOverRos, StartAndStopARecordingAndLeaveAMark) {
  StartServe("--pictures off");
  EXPECT_THAT(Record(false).message, HasSubstr("nothing is recorded now"));
  const auto started = Record(true);
  ASSERT_TRUE(started.success) << started.message;
  EXPECT_FALSE(Record(true).success) << "it runs";
  const auto stopped = Record(false);
  ASSERT_TRUE(stopped.success) << stopped.message;
  EXPECT_EQ(stopped.message, started.message);
  EXPECT_TRUE(std::filesystem::exists(started.message));
  std::string marks;
  ASSERT_TRUE(Spin([&] {
    std::ifstream file(folder_ / "marks.jsonl");
    marks.assign(std::istreambuf_iterator<char>(file), {});
    return marks.find("stopped") != std::string::npos;
  }));
  EXPECT_THAT(marks, HasSubstr(R"("role":"ros")"));
  const auto refused = Call<std_srvs::Trigger>("snapshot");
  EXPECT_FALSE(refused.success);
  EXPECT_THAT(refused.message, HasSubstr("--pictures=off"));
}

}  // namespace
}  // namespace kinescope
