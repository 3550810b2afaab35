// What other computers of the graph need: they reach this one by its name in the network, and have
// none of its files.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <array>
#include <string>

#include "tests/system/ros/ros_fixture.h"
#include "tests/system/run_program.h"
#include "urdf/robot/robot_model.h"

namespace kinescope {
namespace {

using testing::RunProgram;
using ::testing::StartsWith;

// An IPv4 address of this computer that is not 127.x; "" if it has none.
std::string AddressInTheNetwork() {
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return "";
  std::string address;
  for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
    const bool is_reached = one->ifa_addr != nullptr && one->ifa_addr->sa_family == AF_INET &&
                            (one->ifa_flags & IFF_LOOPBACK) == 0 && (one->ifa_flags & IFF_UP) != 0;
    if (!is_reached) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    const auto* const ip = reinterpret_cast<const sockaddr_in*>(one->ifa_addr);
    address = ::inet_ntop(AF_INET, &ip->sin_addr, text.data(), text.size());
  }
  ::freeifaddrs(all);
  return address;
}

using SeenFromAnotherComputer = testing::RosProgram;

TEST_F(SeenFromAnotherComputer, TheBodyHasMeshesThatThisOneServes) {
  const std::string address = AddressInTheNetwork();
  if (address.empty()) GTEST_SKIP() << "this computer is in no network";
  setenv("ROS_IP", address.c_str(), 1);  // of the program; this process has started
  const auto program = Start("bridge demo:lift --ros required");
  const urdf::RobotModel robot = urdf::ParseUrdf(WaitForParameter("/robot_description"));
  int meshes = 0;
  for (const urdf::Link& link : robot.links) {
    for (const urdf::Visual& visual : link.visuals) {
      const std::string& uri = visual.geometry.mesh_uri;
      if (uri.empty()) continue;
      ++meshes;
      ASSERT_THAT(uri, StartsWith("http://" + address + ":"));
      const auto file = RunProgram({"/usr/bin/curl", "-sf", "--noproxy", "*", uri});
      ASSERT_EQ(file.exit_code, 0) << uri;
      ASSERT_GT(file.out.size(), 84U) << uri;
      const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(file.out[80 + i]); };
      const unsigned triangles = byte(0) | byte(1) << 8U | byte(2) << 16U | byte(3) << 24U;
      EXPECT_EQ(file.out.size(), 84 + 50U * triangles) << uri << " is no binary STL file";
    }
  }
  EXPECT_GE(meshes, 23);
}

TEST_F(SeenFromAnotherComputer, ABodyThatOnlyThisOneSeesHasFiles) {
  const auto program = Start("bridge demo:lift --ros required");
  EXPECT_THAT(WaitForParameter("/robot_description"), ::testing::HasSubstr("\"file:///"));
}

}  // namespace
}  // namespace kinescope
