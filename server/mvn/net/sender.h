/// Sends datagrams as a suit does. One thread.
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

  /// Sends `datagram` unchanged. Without a receiver it is lost, as with a real suit.
  /// @throws SourceError if sending can never succeed (datagram too long, address rejected).
  virtual void Send(std::string_view datagram) = 0;

  virtual std::uint64_t datagrams_sent() const = 0;
  /// Datagrams without a receiver: TCP without a connection, or with a receiver that is too slow.
  virtual std::uint64_t datagrams_unsent() const = 0;
  virtual std::string description() const = 0;

 protected:
  DatagramSender() = default;
};

/// `url`: "udp://127.0.0.1:9763"; "tcp://127.0.0.1:9763" connects as MVN does, and again after the
/// connection is lost; "tcp://:9763?listen" waits for receivers to connect and sends to all of
/// them. @throws SourceError with the URL, the error and the expected form.
std::unique_ptr<DatagramSender> OpenSender(const std::string& url);

}  // namespace kinescope::mvn
