/// Receives the MVN stream from a UDP socket. One thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "core/system/ip_networks.h"
#include "server/mvn/datagram_source.h"
#include "server/mvn/net/arrival_clock.h"
#include "server/mvn/net/socket.h"

namespace kinescope::mvn {

/// The receive time is the kernel's time stamp of each datagram. `to` is the destination address of
/// the datagram: one of this machine's, a broadcast or a multicast address.
class UdpDatagrams : public DatagramSource {
 public:
  /// Listens at once. @throws SourceError: see ParseNetUrl() and BindToListen().
  explicit UdpDatagrams(const std::string& url);
  ~UdpDatagrams() override;

  /// kMore after the maximum number of datagrams per call, since more may be available.
  [[nodiscard]] State Poll(std::chrono::nanoseconds timeout, DatagramSink& sink) override;
  TransportCounters counters() const override;
  std::string description() const override { return description_; }
  bool is_live() const override { return true; }

  std::uint16_t port() const { return local_.port; }  // the actual port

 private:
  struct Batch;

  void Configure();
  [[nodiscard]] bool WaitForInput(std::chrono::nanoseconds timeout);
  int ReadBatch(DatagramSink& sink);
  void ReadAncillary(const void* message_header);

  IpNetworks from_;
  Socket socket_;
  std::string description_;
  Endpoint local_;  // address zero if it listens on all addresses
  TransportCounters counters_;
  ArrivalClock clock_;
  std::unique_ptr<Batch> batch_;
};

/// `url`: "udp://:9763" and the other forms of net_url.h. @throws SourceError as the constructor
/// does.
std::unique_ptr<DatagramSource> OpenUdpDatagrams(const std::string& url);

}  // namespace kinescope::mvn
