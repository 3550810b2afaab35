// Publishers that send what no ROS node sends: to the connections that roscpp makes.
#include "server/ros/tcpros_limits.h"

#include <gtest/gtest.h>
#include <ros/connection.h>
#include <ros/poll_set.h>
#include <ros/transport/transport_tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "server/ros/xmlrpc_limits.h"
#include "tests/heap_in_use.h"
#include "tests/server/ros/bad_master.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::uint32_t kLimit = 16 << 20;

// A connection of roscpp to a publisher, and the publisher's end of it.
class TcprosPair {
 public:
  TcprosPair() {
    const int listener = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address = kinescope::testing::Loopback(0);
    socklen_t size = sizeof(address);
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(bind(listener, generic, size), 0);
    EXPECT_EQ(listen(listener, 1), 0);
    getsockname(listener, generic, &size);
    transport_ = boost::make_shared<ros::TransportTCP>(&poll_set_);
    EXPECT_TRUE(transport_->connect("127.0.0.1", ntohs(address.sin_port)));
    publisher_ = accept(listener, nullptr, nullptr);
    close(listener);
    connection_ = boost::make_shared<ros::Connection>();
    connection_->initialize(transport_, false, ros::HeaderReceivedFunc());
  }
  ~TcprosPair() {
    connection_->drop(ros::Connection::Destructing);
    close(publisher_);
  }
  TcprosPair(const TcprosPair&) = delete;
  TcprosPair& operator=(const TcprosPair&) = delete;

  ros::Connection& connection() { return *connection_; }
  // Without a reader; what does not fit is not sent. The number of bytes sent.
  std::size_t Send(const std::string& bytes) const {
    const ssize_t sent = send(publisher_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    return sent > 0 ? static_cast<std::size_t>(sent) : 0;
  }
  // What roscpp's thread does once.
  void Poll() { poll_set_.update(0); }

 private:
  ros::PollSet poll_set_;
  int publisher_ = -1;
  ros::TransportTCPPtr transport_;
  ros::ConnectionPtr connection_;
};

// Reads empty messages one after the other, as a subscription does.
class EmptyMessages {
 public:
  explicit EmptyMessages(ros::Connection& connection) : connection_(connection) { ReadNext(); }
  std::size_t count() const { return count_; }

 private:
  void ReadNext() {
    connection_.read(4, [this](const ros::ConnectionPtr&, const boost::shared_array<std::uint8_t>&,
                               std::uint32_t, bool success) {
      if (!success) return;
      ++count_;
      ReadNext();
    });
  }

  ros::Connection& connection_;
  std::size_t count_ = 0;
};

TEST(TcprosLimits, AFloodIsReadInParts) {
  TcprosPair pair;
  EmptyMessages messages(pair.connection());
  const std::size_t sent = pair.Send(std::string(32'000, '\0')) / 4;
  ASSERT_GT(sent, 4U * kMostTcprosReads);
  pair.Poll();
  EXPECT_GT(messages.count(), 0U);
  EXPECT_LE(messages.count(), static_cast<std::size_t>(kMostTcprosReads));
  for (std::size_t i = 0; i < sent && messages.count() < sent; ++i) pair.Poll();
  EXPECT_EQ(messages.count(), sent);
}

// A cloud of ten million points is lost; the topic is not.
TEST(TcprosLimits, AMessageThatIsTooLongIsLeftOutInBoundedMemory) {
  constexpr std::uint32_t kLong = 160'000'000;
  LimitTcprosMessages(kLimit);
  TcprosPair pair;
  kinescope::testing::LargestAllocation();
  std::vector<std::pair<std::uint32_t, bool>> read;
  const auto note = [&](const auto&, const auto&, std::uint32_t size, bool is_read) {
    read.emplace_back(size, is_read);
  };
  pair.connection().read(kLong, [&](const ros::ConnectionPtr& connection, const auto& bytes,
                                    std::uint32_t size, bool is_read) {
    note(connection, bytes, size, is_read);
    connection->read(3, note);
  });
  const std::string part(1 << 20, 'x');
  for (std::size_t left = kLong; left > 0; pair.Poll()) {
    left -= pair.Send(part.substr(0, std::min(left, part.size())));
  }
  EXPECT_EQ(pair.Send("new"), 3U);
  for (int i = 0; i < 1000 && read.size() < 2; ++i) pair.Poll();
  EXPECT_EQ(read, (std::vector<std::pair<std::uint32_t, bool>>{{0, true}, {3, true}}));
  EXPECT_LT(kinescope::testing::LargestAllocation(), kLimit);
  EXPECT_FALSE(pair.connection().isDropped());
  EXPECT_EQ(RejectedXmlRpc()["a TCPROS message of more than 16 MiB"], 1U);
  LimitTcprosMessages(std::numeric_limits<std::uint32_t>::max());
}

TEST(TcprosLimits, APublisherThatEndsWithinAMessageIsNoMessage) {
  LimitTcprosMessages(kLimit);
  std::vector<bool> read;
  {
    TcprosPair pair;
    pair.connection().read(900'000'000, [&](const auto&, const auto&, std::uint32_t, bool is_read) {
      read.push_back(is_read);
    });
    pair.Send("part");
    pair.Poll();
  }
  for (const bool is_read : read) EXPECT_FALSE(is_read);
  LimitTcprosMessages(std::numeric_limits<std::uint32_t>::max());
}

TEST(TcprosLimits, TheLargestMessageIsRead) {
  LimitTcprosMessages(kLimit);
  TcprosPair pair;
  pair.connection().read(kLimit, [](const auto&, const auto&, std::uint32_t, bool) {});
  EXPECT_FALSE(pair.connection().isDropped());
  LimitTcprosMessages(std::numeric_limits<std::uint32_t>::max());
}

}  // namespace
}  // namespace kinescope::ros_bridge
