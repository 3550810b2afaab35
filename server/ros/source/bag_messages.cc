#include "server/ros/source/bag_messages.h"

#include <utility>

namespace kinescope::ros_bridge {
namespace {

// Memory of a message beside its bytes, about.
constexpr std::size_t kMessageOverhead = 160;

}  // namespace

BagMessages::BagMessages(InputFile file, const BagReader::IsWanted& is_wanted)
    : reader_(std::move(file), is_wanted), is_wanted_(is_wanted) {}

void BagMessages::Fill() {
  BagMessage message;
  while (!has_ended_ && window_bytes_ < kWindowBytes) {
    has_ended_ = !reader_.Next(message);
    if (has_ended_) return;
    ++read_;
    if (!is_wanted_(*message.connection)) {
      ++others_[message.connection];
      continue;
    }
    window_bytes_ += message.bytes.size() + kMessageOverhead;
    window_.emplace(message.recorded_nanos, std::move(message));
  }
}

bool BagMessages::Next(BagMessage& message) {
  Fill();
  if (window_.empty()) return false;
  const auto first = window_.begin();
  message = std::move(first->second);
  window_.erase(first);
  window_bytes_ -= message.bytes.size() + kMessageOverhead;
  return true;
}

}  // namespace kinescope::ros_bridge
