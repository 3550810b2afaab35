// Subscribers that stop reading, as a laptop does whose lid was closed: those that read get every
// sample, and the bridge does not keep what is not taken.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sensor_msgs/JointState.h>
#include <sys/socket.h>
#include <tf2_msgs/TFMessage.h>
#include <unistd.h>
#include <visualization_msgs/MarkerArray.h>
#include <xsens_mvn_ros_msgs/LinkStateArray.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "server/ros/master_client.h"
#include "tests/system/process_memory.h"
#include "tests/system/ros/ros_fixture.h"

namespace kinescope {
namespace {

using ros_bridge::MasterClient;
using ros_bridge::MasterReply;
using ros_bridge::NodeServer;
using testing::MegabytesOf;

// Subscribes as roscpp does, and reads nothing.
class StuckSubscriber {
 public:
  StuckSubscriber(const NodeServer& node, const std::string& topic, const std::string& type) {
    XmlRpc::XmlRpcValue question;
    question[0] = topic;
    question[1][0][0] = "TCPROS";
    MasterReply answer = MasterClient(node.host, node.port).Call("requestTopic", question);
    EXPECT_EQ(answer.code, MasterReply::Code::kGood) << topic;
    const int smallest = 1;  // so that little waits in the kernel
    setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &smallest, sizeof(smallest));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(int(answer.value[2])));
    inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
    EXPECT_EQ(connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    std::string header;
    for (const std::string& field : {std::string("callerid=/stuck"), "topic=" + topic,
                                     "type=" + type, std::string("md5sum=*")}) {
      header += LengthOf(field) + field;
    }
    header = LengthOf(header) + header;
    EXPECT_EQ(send(socket_, header.data(), header.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(header.size()));
  }
  ~StuckSubscriber() { close(socket_); }
  StuckSubscriber(const StuckSubscriber&) = delete;
  StuckSubscriber& operator=(const StuckSubscriber&) = delete;

 private:
  static std::string LengthOf(const std::string& text) {
    const auto size = static_cast<std::uint32_t>(text.size());
    std::string bytes;
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(size >> shift & 0xff);
    return bytes;
  }

  const int socket_ = socket(AF_INET, SOCK_STREAM, 0);
};

class StoppedSubscriber : public testing::RosProgram {};

TEST_F(StoppedSubscriber, CostsTheBridgeNoMemoryAndOthersNoSample) {
  constexpr std::size_t kUntilFull = 1200, kSamples = 2160;  // the queue of a subscriber: 480
  const auto bridge = Start("bridge udp://127.0.0.1:0 --ros required");
  const std::string address = WaitForAddress(*bridge);
  double megabytes = 0;
  std::vector<ros::Time> stamps;
  const auto weigh = [&](const auto& message) {
    megabytes += ros::serialization::serializationLength(message) * 1e-6;
  };
  Hear<xsens_mvn_ros_msgs::LinkStateArray>("/kinescope/link_states", [&](const auto& message) {
    weigh(message);
    stamps.push_back(message.states.at(0).header.stamp);
  });
  Hear<tf2_msgs::TFMessage>("/tf", weigh);
  Hear<sensor_msgs::JointState>("/kinescope/joint_states", weigh);
  Hear<visualization_msgs::MarkerArray>("/kinescope/markers", weigh);
  // The topics are there once there is a person: one sample, and the rest when all are connected.
  ASSERT_EQ(Start("stream demo:walk --rate_hz 240 --seconds 0.05 --to " + address)->WaitForEnd(),
            0);
  ASSERT_TRUE(Spin([&] {
    return std::all_of(subscribers_.begin(), subscribers_.end(),
                       [](const auto& each) { return each.getNumPublishers() == 1; });
  }));
  const auto node = ros_bridge::FindNodeServer("/kinescope");
  ASSERT_TRUE(node);
  const StuckSubscriber links(*node, "/kinescope/link_states", "xsens_mvn_ros_msgs/LinkStateArray"),
      tf(*node, "/tf", "tf2_msgs/TFMessage"),
      joints(*node, "/kinescope/joint_states", "sensor_msgs/JointState"),
      markers(*node, "/kinescope/markers", "visualization_msgs/MarkerArray");

  const auto count = [&] { return std::set<ros::Time>(stamps.begin(), stamps.end()).size(); };
  // Until the first suit has been silent for 0.1 s, another at its address is not taken for it.
  WaitForLine(*bridge, "stale: no data");
  stamps.clear();
  const auto suit = Start("stream demo:walk --rate_hz 480 --seconds 4.5 --to " + address);
  ASSERT_TRUE(Spin([&] { return count() >= kUntilFull; }));
  megabytes = 0;
  const double before = MegabytesOf(bridge->pid(), "VmRSS:");
  EXPECT_TRUE(Spin([&] { return count() >= kSamples; })) << count() << " samples";
  EXPECT_EQ(stamps.size(), count()) << "each once";
  EXPECT_TRUE(std::is_sorted(stamps.begin(), stamps.end()));
  EXPECT_GT(megabytes, 10);
  const double grown = MegabytesOf(bridge->pid(), "VmRSS:") - before;
  EXPECT_LT(grown, megabytes / 3);
  RecordProperty("published_mb", std::to_string(megabytes));
  RecordProperty("grown_mb", std::to_string(grown));
  EXPECT_EQ(suit->WaitForEnd(), 0);
  bridge->Signal(SIGINT);
  EXPECT_EQ(bridge->WaitForEnd(), 0);
}

}  // namespace
}  // namespace kinescope
