/// One end of a TCP connection that is made again whenever it is lost. Nothing blocks and nothing
/// sleeps: whoever uses it waits for `descriptor()` or until `deadline_nanos()`, then calls
/// Advance(). One thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/mvn/net/net_url.h"
#include "server/mvn/net/socket.h"

namespace kinescope::mvn {

class TcpConnector {
 public:
  /// Asks the name service, once. @throws SourceError when the name has no address.
  TcpConnector(const NetUrl& url, const std::string& text);

  /// Goes on with connecting: attempts begin a second apart, each at the next of the host's
  /// addresses. A connection that was made is returned once, ready for use; the connector is then
  /// idle until Restart().
  [[nodiscard]] Socket Advance(std::int64_t now_monotonic_nanos);

  /// The connection that Advance() gave is gone.
  void Restart(std::int64_t now_monotonic_nanos);

  /// What becomes writable when the attempt has an outcome; -1: no attempt.
  int descriptor() const { return attempt_.get(); }
  /// When Advance() has something to do by itself (monotonic).
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
  bool is_connected_ = false;  // somebody uses what Advance() gave
  Socket attempt_;
  std::int64_t began_nanos_ = 0;  // of the newest attempt
  bool has_begun_ = false;        // there was one
  std::int64_t connected_nanos_ = 0;
  bool has_told_trouble_ = false;  // in the log, since the last connection that held
  bool has_told_connection_ = false;
};

/// A connection that just sends or receives: small pieces leave at once, and an end that is gone
/// without a word, or takes nothing, is given up after some ten seconds.
void ConfigureConnection(const Socket& socket);

}  // namespace kinescope::mvn
