/// The time of a node's computer, asked for as NTP does: with the moment of the question and that
/// of the answer. Every Kinescope node answers, as a method of its XML-RPC server; other nodes do
/// not know it.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "server/ros/source/publisher_clock.h"

namespace kinescope::ros_bridge {

/// From now on this node answers. @pre ros::init was called.
void AnswerWithTime();

/// A question to one node; `sent` and `received` of its answer are by the monotonic clock. Nullopt:
/// there is no answer. It throws a std::exception if the answer has no time in it.
using TimeQuestion = std::function<std::optional<RoundTrip>()>;
/// Over XML-RPC, on a connection that is kept. @pre ros::init was called.
TimeQuestion QuestionTo(const std::string& node);

/// Asks nodes on a thread of its own, since a node that is cut off does not answer. Its destructor
/// waits for the question that is under way.
class NodeTimes {
 public:
  explicit NodeTimes(std::function<TimeQuestion(const std::string& node)> question_to = QuestionTo);
  ~NodeTimes();
  NodeTimes(const NodeTimes&) = delete;
  NodeTimes& operator=(const NodeTimes&) = delete;

  /// The nodes to ask, by name, in place of those before. Any thread.
  void SetNodes(std::vector<std::string> nodes);
  /// The answers since the last call. Any thread.
  std::vector<std::pair<std::string, RoundTrip>> Take();
  /// Questions that have failed with an exception; the first one of a node is logged. Any thread.
  std::uint64_t failures() const;

 private:
  struct Node {
    TimeQuestion ask;
    bool has_failed = false;
  };
  void Run();
  void Ask(const std::string& name);

  const std::function<TimeQuestion(const std::string& node)> question_to_;
  mutable std::mutex mutex_;  // never held during a question
  std::condition_variable changed_;
  std::vector<std::string> nodes_;                          // guarded by mutex_
  std::vector<std::pair<std::string, RoundTrip>> answers_;  // guarded by mutex_
  std::uint64_t failures_ = 0;                              // guarded by mutex_
  bool stopping_ = false;                                   // guarded by mutex_
  std::map<std::string, Node> asked_;                       // the thread's
  std::thread thread_;                                      // last: it uses all other members
};

}  // namespace kinescope::ros_bridge
