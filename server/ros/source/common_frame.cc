#include "server/ros/source/common_frame.h"

#include <spdlog/spdlog.h>

#include <utility>

#include "core/system/clocks.h"
#include "core/system/utf8.h"

namespace kinescope::ros_bridge {

CommonFrame::CommonFrame(std::string source, std::string wanted)
    : source_(std::move(source)), wanted_(std::move(wanted)) {}

void CommonFrame::Take(const tf2_msgs::TFMessage& message, bool is_static) {
  // What cannot be used is counted where people are read.
  if (is_static || keeps_moving_) static_cast<void>(tree_.Add(message, is_static));
}

void CommonFrame::Bring(BodySample& sample, const std::string& root, const std::string& of_first) {
  if (root.empty()) return;
  const std::int64_t stamp = sample.stamp_nanos;
  const bool is_wanted = !wanted_.empty() && (of_first == wanted_ || root == wanted_ ||
                                              tree_.Find(wanted_, of_first, stamp));
  const std::string& target = is_wanted ? wanted_ : of_first;
  const bool is_there = root == target;
  const auto place = is_there ? std::make_optional(FramePlace{}) : tree_.Find(target, root, stamp);
  const bool is_as_wanted = wanted_.empty() || is_wanted;
  if (!place || !is_as_wanted) {
    keeps_moving_ = true;
    NoteLost(root, is_as_wanted ? target : wanted_, stamp);
  }
  if (is_there || !place) return;
  const urdf::Pose& frame = place->pose;
  const auto turn = [&](Eigen::Vector3d& v) { v = frame.orientation * v; };
  for (SegmentState& segment : sample.segments) {
    segment.position = frame.position + frame.orientation * segment.position;
    segment.orientation = (frame.orientation * segment.orientation).normalized();
    turn(segment.velocity);
    turn(segment.acceleration);
    turn(segment.angular_velocity);
    turn(segment.angular_acceleration);
  }
}

// The transforms may come some time after the people.
void CommonFrame::NoteLost(const std::string& root, const std::string& target,
                           std::int64_t now_nanos) {
  constexpr std::int64_t kPatienceNanos = 2 * kNanosPerSecond;
  constexpr std::size_t kMostTold = 64;
  if (lost_nanos_ == 0 || now_nanos < lost_nanos_) lost_nanos_ = now_nanos;
  if (now_nanos - lost_nanos_ < kPatienceNanos || told_.size() >= kMostTold) return;
  if (!told_.insert(root).second) return;
  const std::string way_out =
      target == wanted_
          ? fmt::format("; if that is right, give --reference_frame {}", PrintableLine(root))
          : "; publish the transform between them";
  spdlog::warn(
      "{}: people are in the frame '{}', and TF has no way from there to '{}': they are placed as "
      "if these were the same{}",
      source_, PrintableLine(root), PrintableLine(target), way_out);
}

}  // namespace kinescope::ros_bridge
