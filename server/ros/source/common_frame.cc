#include "server/ros/source/common_frame.h"

#include <spdlog/spdlog.h>

#include <utility>

#include "core/system/clocks.h"
#include "core/system/utf8.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::int64_t kFrameTimeoutNanos = 2 * kNanosPerSecond;

bool AreSame(const urdf::Pose& a, const urdf::Pose& b) {
  constexpr double kMetres = 1e-3, kRadians = 1e-3;
  return (a.position - b.position).norm() < kMetres &&
         a.orientation.angularDistance(b.orientation) < kRadians;
}

}  // namespace

CommonFrame::CommonFrame(std::string source, std::string wanted)
    : source_(std::move(source)), wanted_(std::move(wanted)) {}

void CommonFrame::Take(const tf2_msgs::TFMessage& message, bool is_static) {
  // What cannot be used is counted where people are read.
  if (is_static || keeps_moving_) static_cast<void>(tree_.Add(message, is_static));
}

void CommonFrame::Bring(BodySample& sample, const std::string& root, const std::string& of_first) {
  const std::string& target = wanted_.empty() ? of_first : wanted_;
  const std::int64_t now = newest_nanos_ = sample.stamp_nanos;
  if (root.empty() || root == target) return;
  Root& known = roots_[root];
  known.brought_nanos = now;
  auto place = tree_.Find(target, root, now);
  if (place) {
    if (known.lost_nanos != 0) known.problem.clear();
    known.lost_nanos = 0;
    known.is_told_lost = false;
  } else {
    keeps_moving_ = true;
    NoteLost(known, root, of_first, now);
    // Where the first one stays as it is, too.
    if (root != of_first && !tree_.Find(target, of_first, now)) {
      place = tree_.Find(of_first, root, now);
    }
  }
  if (!place) return;
  Hold(known, root, place->pose, now);
  const urdf::Pose& frame = known.held;
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

// A place that is set anew, once, is taken half a second later.
void CommonFrame::Hold(Root& known, const std::string& root, const urdf::Pose& place,
                       std::int64_t now_nanos) const {
  constexpr std::int64_t kStandsNanos = kNanosPerSecond / 2;
  if (!known.is_placed) known.held = known.seen = place;
  known.is_placed = true;
  if (AreSame(place, known.held)) {
    if (known.moved_nanos != 0) known.problem.clear();
    known.moved_nanos = 0;
    known.seen = place;
    return;
  }
  if (known.moved_nanos == 0 || now_nanos < known.moved_nanos) known.moved_nanos = now_nanos;
  if (!AreSame(place, known.seen) || now_nanos < known.seen_nanos) {
    known.seen = place;
    known.seen_nanos = now_nanos;
  }
  if (now_nanos - known.seen_nanos >= kStandsNanos) {
    known.held = place;
    known.problem.clear();
    known.moved_nanos = 0;
    return;
  }
  if (!known.problem.empty() || now_nanos - known.moved_nanos < kFrameTimeoutNanos) return;
  Tell(known,
       fmt::format("people are in the frame '{}', which moves: they are placed where it was first, "
                   "so that their loads are those on a floor that stands",
                   PrintableLine(root)),
       known.is_told_moving);
}

void CommonFrame::Tell(Root& known, std::string problem, bool& is_told) const {
  known.problem = std::move(problem);
  if (!std::exchange(is_told, true)) spdlog::warn("{}: {}", source_, known.problem);
}

std::vector<std::string> CommonFrame::problems() const {
  std::vector<std::string> all;
  for (const auto& [name, root] : roots_) {
    const bool has_people = newest_nanos_ - root.brought_nanos < kFrameTimeoutNanos;
    if (has_people && !root.problem.empty()) all.push_back(root.problem);
  }
  return all;
}

// The transforms may come some time after the people.
void CommonFrame::NoteLost(Root& known, const std::string& root, const std::string& of_first,
                           std::int64_t now_nanos) const {
  if (known.lost_nanos == 0 || now_nanos < known.lost_nanos) known.lost_nanos = now_nanos;
  if (known.is_told_lost || now_nanos - known.lost_nanos < kFrameTimeoutNanos) return;
  const std::string way_out =
      root == of_first
          ? fmt::format("; if that is right, give --reference_frame {}", PrintableLine(root))
          : "; publish the transform between them";
  Tell(known,
       fmt::format("people are in the frame '{}', and TF has no way from there to '{}': they are "
                   "placed as if these were the same{}",
                   PrintableLine(root), PrintableLine(wanted_.empty() ? of_first : wanted_),
                   way_out),
       known.is_told_lost);
}

}  // namespace kinescope::ros_bridge
