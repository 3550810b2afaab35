#include "server/ros/frame_ways.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/system/utf8.h"

namespace kinescope::ros_bridge {
namespace {

using Frames = std::unordered_map<std::string, TreeFrame>;

constexpr std::size_t kMostOfLoop = 8, kMostOfFrame = 100;  // names; bytes

std::string Shown(const std::string& frame) { return PrintableLine(frame.substr(0, kMostOfFrame)); }

// From a frame up to the one that hangs on none, or on one of those before it.
struct Way {
  std::vector<std::string> frames;
  std::string again;  // that one; "": none
};

Way WayUp(const Frames& frames, const std::string& from) {
  Way way{{from}, ""};
  std::set<std::string> gone = {from};
  while (way.again.empty()) {
    const auto found = frames.find(way.frames.back());
    if (found == frames.end() || found->second.parent.empty()) break;
    const std::string& parent = found->second.parent;
    if (gone.insert(parent).second) {
      way.frames.push_back(parent);
    } else {
      way.again = parent;
    }
  }
  return way;
}

std::string LoopText(const Way& way) {
  const auto begin = std::find(way.frames.begin(), way.frames.end(), way.again);
  std::string text;
  std::size_t count = 0;
  for (auto each = begin; each != way.frames.end(); ++each) {
    text += ++count > kMostOfLoop ? "" : Shown(*each) + ", ";
  }
  return text + (count > kMostOfLoop ? "…, " : "") + Shown(way.again);
}

}  // namespace

std::string RootOf(const Frames& frames, const std::string& near) {
  const auto root_of = [&](std::string frame) {
    // A loop ends where it has been gone through.
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const auto found = frames.find(frame);
      if (found == frames.end() || found->second.parent.empty()) break;
      frame = found->second.parent;
    }
    return frame;
  };
  if (frames.count(near) != 0) return root_of(near);
  std::map<std::string, int> sizes;
  for (const auto& [name, frame] : frames) ++sizes[root_of(name)];
  const auto largest = std::max_element(
      sizes.begin(), sizes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return largest == sizes.end() ? "" : largest->first;
}

std::string WhyNotFound(const TfTree& tf, const std::string& frame, const std::string& target) {
  const Frames& frames = tf.frames();
  if (const std::string why = tf.WhySkipped(frame); !why.empty()) {
    return fmt::format("frame '{}' is not known: its transforms are those {}", Shown(frame), why);
  }
  if (frames.count(frame) == 0) return fmt::format("frame '{}' is not known yet", Shown(frame));
  const Way way = WayUp(frames, frame);
  const std::string& root = way.frames.back();
  if (!way.again.empty()) {
    const bool is_in_it = way.again == frame;
    return fmt::format("frame '{}' {} a loop of TF: {}", Shown(frame),
                       is_in_it ? "is in" : "hangs on", LoopText(way));
  }
  const Way of_target = WayUp(frames, target);
  if (of_target.again.empty() && of_target.frames.back() == root) {
    return fmt::format("the transforms between '{}' and '{}' have no time in common", Shown(frame),
                       Shown(target));
  }
  if (root == frame) {
    return fmt::format("frame '{}' has no way to '{}' in TF", Shown(frame), Shown(target));
  }
  return fmt::format("frame '{}' hangs on '{}', which has no way to '{}' in TF", Shown(frame),
                     Shown(root), Shown(target));
}

std::string OtherTreeOf(const TfTree& tf, const std::string& frame, const std::string& target) {
  const Frames& frames = tf.frames();
  if (frames.count(frame) == 0) return "";
  Way way = WayUp(frames, frame);
  const Way of_target = WayUp(frames, target);
  if (!way.again.empty() || !of_target.again.empty()) return "";
  return way.frames.back() == of_target.frames.back() ? "" : std::move(way.frames.back());
}

}  // namespace kinescope::ros_bridge
