/// Receives the MVN stream over TCP. MVN makes the connection, so this normally listens; several
/// senders may connect, and each is a separate stream. With a host in its URL it connects instead,
/// and again whenever the connection is lost. One thread.
#pragma once

#include <poll.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/system/ip_networks.h"
#include "server/mvn/datagram_source.h"
#include "server/mvn/net/arrival_clock.h"
#include "server/mvn/net/socket.h"
#include "server/mvn/net/tcp_connector.h"

namespace kinescope::mvn {

/// The receive time is the kernel's time stamp of the bytes. `from` and `to` are the ends of
/// the connection.
class TcpDatagrams : public DatagramSource {
 public:
  /// A further connection takes the place of one that gives way (giving_way.h); without such a one
  /// it is rejected: closed at once.
  static constexpr std::size_t kMaxConnections = 16;

  /// How long the sender of a connection that was accepted may take, ns.
  struct Patience {
    std::int64_t first_datagram = 60'000'000'000, next_datagram = 600'000'000'000;  // else it ends
    std::int64_t next_body = 3'000'000'000;  // else it counts as one that has none
  };

  /// Listens at once; or resolves the host and starts to connect with the first Poll(). It is not
  /// an error if the other end does not exist yet.
  /// @throws SourceError: see ParseNetUrl(), BindToListen() and ResolveToSend().
  explicit TcpDatagrams(const std::string& url) : TcpDatagrams(url, Patience()) {}
  TcpDatagrams(const std::string& url, const Patience& patience);
  ~TcpDatagrams() override;

  /// Reads once from each connection with data; kMore if one may have more. Returns early when a
  /// connection is opened or closed.
  [[nodiscard]] State Poll(std::chrono::nanoseconds timeout, DatagramSink& sink) override;
  TransportCounters counters() const override;
  std::string description() const override { return description_; }
  bool is_live() const override { return true; }

  std::uint16_t port() const { return port_; }  // the actual port

 private:
  struct Connection;

  [[nodiscard]] bool WaitForInput(std::chrono::nanoseconds timeout);
  void CollectDescriptors(std::int64_t now);
  std::int64_t Deadline(std::int64_t now, std::chrono::nanoseconds timeout) const;
  void AcceptAll(std::int64_t now);
  void Add(Socket socket, std::int64_t now);
  [[nodiscard]] bool MakeRoom(const Endpoint& newcomer, std::int64_t now);
  [[nodiscard]] bool Read(Connection& connection, DatagramSink& sink);
  void EndIdle(std::int64_t now);
  void RemoveEnded(std::int64_t now);
  void Remember(const Connection& connection);

  const Patience patience_;
  std::string description_;
  IpNetworks from_;
  std::uint16_t port_ = 0;
  Socket listener_;                        // when listening
  std::optional<TcpConnector> connector_;  // when connecting
  std::int64_t accept_again_nanos_ = 0;    // monotonic clock; accepting fails before
  ArrivalClock clock_{ReadClocks()};       // for its steps; each connection has one for its stamps
  std::vector<std::unique_ptr<Connection>> connections_;
  std::vector<pollfd> descriptors_;  // to wait for: connections in their order, then listener_ or
                                     // connector_
  std::string buffer_;
  TransportCounters counters_;  // of closed connections
};

/// `url`: "tcp://:9763" and the other forms of net_url.h. @throws SourceError as the constructor
/// does.
std::unique_ptr<DatagramSource> OpenTcpDatagrams(const std::string& url);

}  // namespace kinescope::mvn
