#include "server/app/stream/stream_feed.h"

#include <cmath>

#include "core/system/errors.h"
#include "server/mvn/open.h"
#include "server/ros/source/graph_source.h"

namespace kinescope::app {

std::optional<int> CharacterIds::Find(int character, int copy) {
  constexpr int kMaxIds = 256;  // one byte
  if (copies_ == 1) return character;
  const auto first = first_.try_emplace(character, copies_ * static_cast<int>(first_.size())).first;
  const int id = first->second + copy;
  if (id >= kMaxIds) return std::nullopt;
  return id;
}

bool Decimator::Keeps(double stream_hz, std::uint32_t counter, std::int64_t time_nanos,
                      std::int64_t clock_step_nanos) {
  constexpr std::size_t kRemembered = 8;
  if (stream_hz == 0) return true;
  for (const Decision& decision : latest_) {
    if (decision.counter == counter) return decision.keep;
  }
  // The clock is rounded, so a frame at the very beginning of a slot may seem to lie before it.
  const auto slot = static_cast<std::int64_t>(
      std::floor(static_cast<double>(time_nanos + clock_step_nanos) * 1e-9 * stream_hz));
  Decision decision{counter, latest_.empty() || slot != slot_};
  // A clock that stands still cannot tell which ones to leave out.
  if (!latest_.empty() && time_nanos == time_nanos_) {
    decision.keep = latest_[(next_ + kRemembered - 1) % kRemembered].keep;
  }
  slot_ = slot;
  time_nanos_ = time_nanos;
  if (latest_.empty()) latest_.assign(kRemembered, decision);
  latest_[next_] = decision;
  next_ = (next_ + 1) % kRemembered;
  return decision.keep;
}

std::unique_ptr<Feed> OpenFeed(const FeedSettings& settings) {
  const bool is_pipe = settings.source == "-";
  if (settings.loop && is_pipe) {
    throw UsageError("--loop: standard input cannot be read twice; save it to a file first");
  }
  auto datagrams = mvn::OpenDatagrams(settings.source);
  if (datagrams == nullptr) {
    if (is_pipe) {
      throw SourceError(
          "standard input: only captures and raw datagrams can be streamed from a pipe; save it to "
          "a file first");
    }
    if (ros_bridge::IsGraphUrl(settings.source)) {
      throw SourceError(
          "source '" + settings.source +
          "': a live ROS graph cannot be streamed as a suit; record it (rosbag record "
          "/tf) and stream the bag");
    }
    return MakeSampleFeed(settings);
  }
  if (settings.gloves || settings.props > 0) {
    throw UsageError(std::string(settings.gloves ? "--gloves" : "--props") + ": '" +
                     settings.source +
                     "' contains datagrams, which are forwarded unchanged; gloves and props can be "
                     "added only to MVNX, ROS bags, demo: and pose:");
  }
  if (datagrams->is_live() && settings.speed != 1) {
    throw UsageError("--speed: '" + settings.source +
                     "' is a live stream; its speed cannot be changed");
  }
  if (datagrams->is_live() && settings.loop) {
    throw UsageError("--loop: '" + settings.source + "' is a live stream without an end");
  }
  return MakeDatagramFeed(settings, std::move(datagrams));
}

}  // namespace kinescope::app
