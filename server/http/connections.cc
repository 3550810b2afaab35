#include "server/http/connections.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace kinescope::http {

bool Connections::MakeRoomFor(const std::string& address, Clock::time_point now) {
  if (CountOf(address) >= kMaxPerAddress) return CloseOne(&address, now);
  return open_.size() < kMax || CloseOne(nullptr, now);
}

void Connections::Remove(const Connection& connection) {
  open_.erase(std::remove(open_.begin(), open_.end(), &connection), open_.end());
}

std::size_t Connections::CountOf(const std::string& address) const {
  return static_cast<std::size_t>(
      std::count_if(open_.begin(), open_.end(),
                    [&](const Connection* connection) { return connection->address == address; }));
}

std::size_t Connections::CountBusy() const {
  return static_cast<std::size_t>(
      std::count_if(open_.begin(), open_.end(), [](const Connection* connection) {
        return connection->phase != Connection::Phase::kWaiting;
      }));
}

// Without the token first, then of the address with the most connections unless these are few, then
// those without progress, then the oldest. Connections with and without the token are counted
// separately: those of a whole office must not spoil its next one.
bool Connections::CloseOne(const std::string* of_address, Clock::time_point now) {
  std::map<std::pair<std::string, bool>, std::size_t> counts;
  for (const Connection* connection : open_) {
    ++counts[{connection->address, connection->has_token}];
  }
  Connection* victim = nullptr;
  const auto rank = [&](const Connection& connection) {
    const std::size_t count = counts.at({connection.address, connection.has_token});
    const bool is_waiting = connection.phase == Connection::Phase::kWaiting;
    const bool is_new = count <= kFew && now - connection.opened < kFirstRequest;
    const bool is_served = is_waiting ? is_new : now - connection.since < kStalled;
    return std::tuple(connection.has_token, -static_cast<double>(count > kFew ? count : 0),
                      is_served, is_served ? connection.opened : connection.since);
  };
  for (Connection* connection : open_) {
    const bool is_drawing = connection->phase == Connection::Phase::kDrawing;
    if (is_drawing && now - connection->since < kLongestDrawing) continue;
    if (of_address != nullptr && connection->address != *of_address) continue;
    if (victim == nullptr || rank(*connection) < rank(*victim)) victim = connection;
  }
  if (victim == nullptr) return false;
  Remove(*victim);
  victim->close();
  return true;
}

}  // namespace kinescope::http
