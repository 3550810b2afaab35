/// Shares the HTTP connections of the server between its clients. When they are used up, one is
/// closed for the new one: of the address that has most, if that is more than kFew; otherwise one
/// that waits for its request, or whose client does not read its answer, and of these the one
/// without progress for the longest time. So clients that connect and send nothing, or read nothing
/// or slowly, cannot lock out others. Connections on which the token was sent go last. Time is an
/// argument. Server's thread only.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "server/http/bucket.h"

namespace kinescope::http {

/// One open connection; its owner keeps the values up to date.
struct Connection {
  enum class Phase { kWaiting, kDrawing, kWriting };

  std::string address;
  bool has_token = false;         // its last request had the token
  Phase phase = Phase::kWaiting;  // for (the rest of) a request, for a snapshot, for its reader
  Clock::time_point opened{};
  Clock::time_point since{};  // of the phase; kWriting: when the client last read a part
  std::function<void()> close;
};

class Connections {
 public:
  static constexpr std::size_t kMax = 256;  // WebSockets are not counted here
  static constexpr std::size_t kMaxPerAddress = 64;
  static constexpr std::size_t kFew = 6;  // a browser opens so many
  /// A client that has read nothing for this time is treated like one that waits.
  static constexpr std::chrono::seconds kStalled{1};
  /// A new connection of an address with few has this time to send its request.
  static constexpr std::chrono::seconds kFirstRequest{1};
  /// After this time, a connection for which a snapshot is rendered may be closed, too.
  static constexpr std::chrono::seconds kLongestDrawing{60};

  /// Makes room for one more of `address`, by closing another if necessary. False if snapshots are
  /// being rendered for all that could be closed.
  [[nodiscard]] bool MakeRoomFor(const std::string& address, Clock::time_point now);
  /// `connection` is borrowed until it is removed.
  void Add(Connection& connection) { open_.push_back(&connection); }
  void Remove(const Connection& connection);  // does nothing for one that was closed
  [[nodiscard]] std::size_t size() const { return open_.size(); }
  /// Those whose answer is made or sent.
  [[nodiscard]] std::size_t CountBusy() const;

 private:
  [[nodiscard]] std::size_t CountOf(const std::string& address) const;
  [[nodiscard]] bool CloseOne(const std::string* of_address, Clock::time_point now);

  std::vector<Connection*> open_;
};

}  // namespace kinescope::http
