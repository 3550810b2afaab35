/// What the tests with real sockets share: a sink that remembers, and waiting for the event itself.
#pragma once

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "core/system/errors.h"
#include "server/mvn/datagram_source.h"
#include "server/mvn/net/socket.h"
#include "tests/server/mvn/mvn_testing.h"

namespace kinescope::mvn::testing {

struct RecordingDatagrams : DatagramSink {
  struct Received {
    Endpoint from;
    Endpoint to;
    std::string bytes;
    Arrival arrival;
  };
  std::vector<Received> all;

  void OnDatagram(const ReceivedDatagram& datagram) override {
    all.push_back({datagram.from, datagram.to, std::string(datagram.bytes), datagram.arrival});
  }
  std::vector<std::string> bytes() const {
    std::vector<std::string> bytes;
    for (const Received& received : all) bytes.push_back(received.bytes);
    return bytes;
  }
};

inline std::chrono::steady_clock::time_point TestDeadline() {
  return std::chrono::steady_clock::now() + std::chrono::seconds(20);
}

/// Polls until `is_done`; false when the source ends before, or after 20 s, which only a failure
/// can take.
template <class Source, class Sink, class Condition>
bool PollUntil(Source& source, Sink& sink, const Condition& is_done) {
  const auto deadline = TestDeadline();
  while (!is_done()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    if (source.Poll(std::chrono::milliseconds(20), sink) == Source::State::kEnded) return is_done();
  }
  return true;
}

inline constexpr const char* kListenOnLoopback = "tcp://127.0.0.1:0?listen";

inline bool HasIpv6() {
  const Socket probe(::socket(AF_INET6, SOCK_DGRAM, 0));
  sockaddr_in6 loopback{};
  loopback.sin6_family = AF_INET6;
  loopback.sin6_addr = in6addr_loopback;
  return bind(probe.get(), reinterpret_cast<sockaddr*>(&loopback), sizeof loopback) == 0;
}

/// A socket that is connected to `url` ("udp://127.0.0.1:40000"), and sends what a test wants.
class Client {
 public:
  explicit Client(const std::string& url) {
    const NetUrl parsed = ParseNetUrl(url);
    const SocketAddress to = ResolveToSend(parsed, url).front();
    const int type = parsed.protocol == Protocol::kUdp ? SOCK_DGRAM : SOCK_STREAM;
    socket_ = Socket(::socket(to.storage.ss_family, type, 0));
    if (connect(socket_.get(), to.get(), to.size) != 0) {
      ADD_FAILURE() << url << ": " << ErrorText(errno);
    }
  }

  void Send(const std::string& bytes) {
    ASSERT_EQ(send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()))
        << ErrorText(errno);
  }
  void Close() { socket_ = Socket(); }

  const Socket& socket() const { return socket_; }
  Endpoint local() const { return EndpointOf(LocalAddress(socket_)); }
  Endpoint peer() const { return EndpointOf(PeerAddress(socket_)); }

 private:
  Socket socket_;
};

/// A plain listening socket.
class Listener {
 public:
  Listener() : Listener(kListenOnLoopback) {}
  explicit Listener(const std::string& url) : socket_(BindToListen(ParseNetUrl(url), url)) {}

  std::string url() const { return FormatUrl(Protocol::kTcp, LocalAddress(socket_)); }
  Socket Accept() const { return Socket(accept(socket_.get(), nullptr, nullptr)); }

 private:
  Socket socket_;
};

/// A whole pose, 760 bytes.
inline std::string Pose(std::uint32_t counter) {
  RawDatagram raw;
  raw.counter = counter;
  raw.items = 23;
  raw.payload = PoseItems(1, 23);
  return raw.Bytes();
}

}  // namespace kinescope::mvn::testing
