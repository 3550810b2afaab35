#include "server/ros/source/publisher_clocks.h"

#include <spdlog/spdlog.h>

#include <iterator>

#include "core/system/clocks.h"
#include "core/system/utf8.h"

namespace kinescope::ros_bridge {

std::int64_t PublisherClocks::OnMessage(const std::string& node, std::int64_t stamp,
                                        std::int64_t arrival) {
  const auto known = nodes_.find(node);
  if (known == nodes_.end()) return 0;
  known->second.OnStamp(stamp, arrival);
  return known->second.shift();
}

void PublisherClocks::OnPerson(const std::string& node, std::int64_t stamp, std::int64_t arrival) {
  constexpr std::size_t kLongestName = 255;
  if (nodes_.count(node) > 0) return;
  if (nodes_.size() >= kMostNodes || node.size() > kLongestName) {
    if (std::exchange(has_said_full_, true)) return;
    spdlog::warn(
        "the clock of {} is not compared: only those of {} nodes with names of at most {} bytes "
        "are",
        PrintableLine(node.substr(0, kLongestName)), kMostNodes, kLongestName);
    return;
  }
  nodes_[node].OnStamp(stamp, arrival);
  TellWhomToAsk();
}

void PublisherClocks::OnOwnClockSet(std::int64_t by) {
  for (auto& [name, clock] : nodes_) clock.OnOwnClockSet(by);
}

void PublisherClocks::Update(std::int64_t monotonic_nanos, std::int64_t wall_offset) {
  constexpr std::int64_t kForgetAfter = 60 * kNanosPerSecond;
  now_ = monotonic_nanos + wall_offset;
  for (auto& [name, trip] : times_.Take()) {
    const auto node = nodes_.find(name);
    if (node == nodes_.end()) continue;
    node->second.OnRoundTrip({trip.sent + wall_offset, trip.received + wall_offset, trip.theirs});
  }
  const std::size_t before = nodes_.size();
  for (auto node = nodes_.begin(); node != nodes_.end();) {
    const bool is_gone = now_ - node->second.heard() > kForgetAfter;
    node = is_gone ? nodes_.erase(node) : std::next(node);
  }
  if (nodes_.size() < before) TellWhomToAsk();
}

std::vector<NodeClock> PublisherClocks::Report() const {
  std::vector<NodeClock> all;
  for (const auto& [name, clock] : nodes_) all.push_back(clock.Report(name, now_));
  return all;
}

void PublisherClocks::TellWhomToAsk() {
  std::vector<std::string> names;
  for (const auto& [name, clock] : nodes_) names.push_back(name);
  times_.SetNodes(std::move(names));
}

}  // namespace kinescope::ros_bridge
