/// The clocks of the nodes that publish people to a source: their stamps in messages, their answers
/// to questions, and what to add to their stamps. Memory is limited; no thread of its own beside
/// that of NodeTimes; used by one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/node_clock.h"
#include "server/ros/node_time.h"
#include "server/ros/source/publisher_clock.h"

namespace kinescope::ros_bridge {

class PublisherClocks {
 public:
  static constexpr std::size_t kMostNodes = 64;

  /// `question_to`: as in NodeTimes.
  explicit PublisherClocks(
      std::function<TimeQuestion(const std::string& node)> question_to = QuestionTo)
      : times_(std::move(question_to)) {}

  /// A message of `node`: its newest stamp, ns, and its arrival by this computer's wall clock.
  /// Returns what to add to its stamps: 0 for a node that has published no person.
  std::int64_t OnMessage(const std::string& node, std::int64_t stamp, std::int64_t arrival);
  /// The same message had a person: from now on the node's clock is compared and reported. Beyond
  /// kMostNodes it is not; the first one is logged.
  void OnPerson(const std::string& node, std::int64_t stamp, std::int64_t arrival);
  /// This computer's wall clock was set. @param by ns
  void OnOwnClockSet(std::int64_t by);
  /// Takes the answers of the nodes; call it regularly. `wall_offset`: wall clock minus monotonic
  /// clock, ns.
  void Update(std::int64_t monotonic_nanos, std::int64_t wall_offset);

  /// As of the last Update, by name: while they publish people and for a minute after that.
  std::vector<NodeClock> Report() const;
  /// Questions that have failed (node_time.h).
  std::uint64_t failures() const { return times_.failures(); }

 private:
  void TellWhomToAsk();

  std::map<std::string, PublisherClock> nodes_;
  std::int64_t now_ = 0;  // of the last Update, wall clock
  bool has_said_full_ = false;
  NodeTimes times_;
};

}  // namespace kinescope::ros_bridge
