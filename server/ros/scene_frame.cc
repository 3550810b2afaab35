#include "server/ros/scene_frame.h"

#include <spdlog/spdlog.h>

#include <utility>

#include "core/system/utf8.h"
#include "server/ros/frame_ways.h"

namespace kinescope::ros_bridge {

SceneFrame::SceneFrame(std::string wanted, std::shared_ptr<const TfTree> tf)
    : wanted_(std::move(wanted)), tf_(std::move(tf)), name_(wanted_) {}

std::string SceneFrame::Find(const std::string& of_marker) const {
  if (has_person_ || tf_->Knows(wanted_)) return wanted_;
  std::string root = RootOf(tf_->frames(), name_);
  if (!root.empty()) return root;
  // Messages may come before the frames.
  constexpr int kLooksWithoutFrames = 4;
  return of_marker.empty() || looks_ <= kLooksWithoutFrames ? name_ : of_marker;
}

bool SceneFrame::IsDue(std::int64_t monotonic_nanos) const {
  constexpr std::int64_t kEveryNanos = 500'000'000;
  if (has_person_) return name_ != wanted_;
  return looked_nanos_ == 0 || monotonic_nanos - looked_nanos_ >= kEveryNanos;
}

void SceneFrame::Update(std::int64_t monotonic_nanos, const std::string& of_marker) {
  looked_nanos_ = monotonic_nanos;
  ++looks_;
  std::string now = Find(of_marker);
  if (now == name_) return;
  name_ = std::move(now);
  spdlog::info("the scene stands in the frame '{}'{}", PrintableLine(name_),
               name_ == wanted_ ? "" : fmt::format(": TF has none called '{}'", wanted_));
}

}  // namespace kinescope::ros_bridge
