/// Sends datagrams where a suit would send them. One thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace kinescope::mvn {

class DatagramSender {
 public:
  virtual ~DatagramSender() = default;
  DatagramSender(const DatagramSender&) = delete;
  DatagramSender& operator=(const DatagramSender&) = delete;

  /// Sends `datagram` as it is. Where nobody listens it is gone, as with a real suit.
  /// @throws SourceError when sending can never work (a datagram too long, an address refused).
  virtual void Send(std::string_view datagram) = 0;

  virtual std::uint64_t datagrams_sent() const = 0;
  /// Datagrams that found no receiver: TCP without a connection, or one that is too slow.
  virtual std::uint64_t datagrams_unsent() const = 0;
  virtual std::string description() const = 0;

 protected:
  DatagramSender() = default;
};

/// `url`: "udp://127.0.0.1:9763"; "tcp://127.0.0.1:9763" connects as MVN does, and again when the
/// connection is lost; "tcp://:9763?listen" waits for receivers to connect and sends to all.
/// @throws SourceError naming the URL, what is wrong with it and what would be right.
std::unique_ptr<DatagramSender> OpenSender(const std::string& url);

}  // namespace kinescope::mvn
