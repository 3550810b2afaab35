/// Keeps one outgoing TCP connection: connects again when it is lost. It never blocks or sleeps:
/// the caller waits for `descriptor()` or until `deadline_nanos()`, then calls Advance(). One
/// thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/mvn/net/net_url.h"
#include "server/mvn/net/socket.h"

namespace kinescope::mvn {

class TcpConnector {
 public:
  /// Queries the name service once. @throws SourceError if the name has no address.
  TcpConnector(const NetUrl& url, const std::string& text);

  /// Continues connecting: attempts start one second apart, each at the next address of the host.
  /// An established connection is returned once, ready for use; the connector is then idle until
  /// Restart().
  [[nodiscard]] Socket Advance(std::int64_t now_monotonic_nanos);

  /// Reports that the connection returned by Advance() is lost.
  void Restart(std::int64_t now_monotonic_nanos);

  /// Becomes writable when the attempt has succeeded or failed; -1: no attempt.
  int descriptor() const { return attempt_.get(); }
  /// When to call Advance() even without an event (monotonic clock, ns).
  /// @pre no connection is in use
  std::int64_t deadline_nanos() const;

 private:
  void Begin(std::int64_t now);
  [[nodiscard]] bool Finish();
  void Fail(int error);
  void TellTrouble(const std::string& what);

  std::string text_;
  std::vector<SocketAddress> addresses_;
  std::size_t next_address_ = 0;
  bool is_connected_ = false;  // the connection from Advance() is in use
  Socket attempt_;
  std::int64_t began_nanos_ = 0;  // of the newest attempt
  bool has_begun_ = false;        // there was an attempt
  std::int64_t connected_nanos_ = 0;
  bool has_told_trouble_ = false;  // logged since the last stable connection
  bool has_told_connection_ = false;
};

/// Sets up a connection that only sends or only receives: small pieces are sent at once, and it is
/// closed after about ten seconds if the other end is lost or accepts nothing.
void ConfigureConnection(const Socket& socket);

}  // namespace kinescope::mvn
