// What `rosbag record -a` keeps of a session is drawn as its source is, with the loads that were
// told to its node, and with what other nodes published meanwhile.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "render/image/png_file.h"
#include "server/ros/master_client.h"
#include "tests/csv_table.h"
#include "tests/shared_data.h"
#include "tests/system/ros/ros_fixture.h"
#include "tests/system/run_program.h"

namespace kinescope {
namespace {

using testing::KinescopePath;
using testing::Process;
using testing::RunProgram;

constexpr int kRateHz = 60;
constexpr char kArm[] =
    "<robot name='arm'><link name='arm_base'><visual><geometry><box size='0.3 0.3 1'/></geometry>"
    "<material name='y'><color rgba='0.9 0.8 0.05 1'/></material></visual></link></robot>";

class RecordedSession : public testing::RosProgram {
 protected:
  // The topics that the node has a connection to the recorder for.
  static std::set<std::string> Recorded(const std::string& node) {
    const auto server = ros_bridge::FindNodeServer(node);
    if (!server) return {};
    ros_bridge::MasterReply bus =
        ros_bridge::MasterClient(server->host, server->port).Call("getBusInfo", {});
    if (bus.code != ros_bridge::MasterReply::Code::kGood) return {};
    std::set<std::string> topics;
    for (int i = 0; i < bus.value.size(); ++i) {
      XmlRpc::XmlRpcValue& connection = bus.value[i];
      const bool is_out = std::string(connection[2]) == "o";
      if (is_out && std::string(connection[1]) == "/recorder") topics.insert(connection[4]);
    }
    return topics;
  }

  static std::size_t YellowPixels(const render::Image& image) {
    std::size_t count = 0;
    for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
      const std::uint8_t* const p = &image.rgba[i];
      count += p[0] > 100 && p[1] > 90 && p[2] < 60 ? 1 : 0;
    }
    return count;
  }

  render::Image Render(const std::string& source, double secs,
                       const std::vector<std::string>& more) const {
    const std::string file = (folder_ / "picture.png").string();
    std::vector<std::string> command = {
        KinescopePath(), "render",  source,     "--time", fmt::format("{:.6f}", secs),
        "--size",        "640x480", "--camera", "front",  "--force",
        "--out",         file};
    command.insert(command.end(), more.begin(), more.end());
    const auto result = RunProgram(command);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return render::ReadPng(file);
  }

  // Of each sample of the bag, s from the first. On a busy machine its stamps are up to tens of
  // milliseconds beside the rate.
  std::vector<double> TimesOf(const std::string& bag) const {
    const std::string file = (folder_ / "times.csv").string();
    const auto result = RunProgram({KinescopePath(), "convert", bag, "--out", file});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const testing::CsvTable table(testing::ReadFile(file));
    std::vector<double> times;
    for (std::size_t i = 0; i < table.rows.size(); ++i) times.push_back(table.Number(i, "time_s"));
    return times;
  }

  static double Psnr(const render::Image& a, const render::Image& b) {
    if (a.rgba.size() != b.rgba.size()) return 0;
    double squares = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
      squares += std::pow(static_cast<double>(a.rgba[i]) - b.rgba[i], 2);
    }
    return 10 * std::log10(255.0 * 255 / (squares / static_cast<double>(a.rgba.size())));
  }
};

TEST_F(RecordedSession, IsDrawnAsItsSourceIsAndWithWhatOtherNodesPublished) {
  const std::string source = (folder_ / "lift.mvnx").string();
  const std::string bag = (folder_ / "session.bag").string();
  ASSERT_EQ(RunProgram({KinescopePath(), "convert", "demo:lift", "--seconds", "2.1", "--rate_hz",
                        std::to_string(kRateHz), "--out", source})
                .exit_code,
            0);
  tf2_msgs::TFMessage place;
  place.transforms.resize(1);
  place.transforms[0].header.frame_id = "world";
  place.transforms[0].child_frame_id = "arm_base";
  place.transforms[0].transform.translation.y = 0.8;
  place.transforms[0].transform.translation.z = 0.5;
  place.transforms[0].transform.rotation.w = 1;
  const ros::Publisher places = node_->advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
  places.publish(place);
  const auto bridge =
      Start("bridge udp://127.0.0.1:0 --ros required --mass 95 --hand_load both:12");
  const std::string address = WaitForAddress(*bridge);
  Process recorder({KINESCOPE_ROSBAG_RECORD, "-a", "-O", bag, "__name:=recorder"});
  ASSERT_TRUE(Spin([&] {
    const std::set<std::string> topics = Recorded("/kinescope");
    return topics.count("/tf") != 0 && topics.count("/kinescope/link_states") != 0 &&
           places.getNumSubscribers() > 0;
  }));
  EXPECT_EQ(Start("stream '" + source + "' --to " + address)->WaitForEnd(), 0);
  recorder.Signal(SIGINT);
  recorder.WaitForEnd();

  // The bag knows what the node was told, from the first sample on.
  const std::vector<double> times = TimesOf(bag);
  ASSERT_GT(times.size(), 2U * kRateHz);
  for (std::size_t n = 0; n <= 2 * kRateHz; n += kRateHz / 2) {
    constexpr double kAfterSecs = 1e-4;  // times have a microsecond
    const std::vector<std::string> seen = {"--overlay", "-title,-names,-time"};
    std::vector<std::string> told = {"--mass", "95", "--hand_load", "both:12"};
    told.insert(told.end(), seen.begin(), seen.end());
    const render::Image of_source =
        Render(source, static_cast<double>(n) / kRateHz + kAfterSecs, told);
    EXPECT_GT(Psnr(Render(bag, times[n] + kAfterSecs, seen), of_source), 35)
        << "sample " << n << " at " << times[n] << " s";
  }
  const render::Image drawn = Render(bag, 1.5, {"--no_overlays"});
  const std::string urdf = (folder_ / "arm.urdf").string();
  std::ofstream(urdf) << kArm;
  EXPECT_GT(YellowPixels(Render(bag, 1.5, {"--no_overlays", "--robot", urdf + "@tf"})),
            YellowPixels(drawn) + 2000);
  const auto elsewhere = RunProgram({KinescopePath(), "render", source, "--robot", urdf + "@tf",
                                     "--out", (folder_ / "x.png").string()});
  EXPECT_NE(elsewhere.exit_code, 0);
  EXPECT_NE(elsewhere.err.find("is no ROS bag"), std::string::npos) << elsewhere.err;
}

}  // namespace
}  // namespace kinescope
