#include "server/ros/force_frames.h"

#include <console_bridge/console.h>
#include <spdlog/fmt/fmt.h>
#include <tf2/exceptions.h>

#include <algorithm>
#include <cmath>

#include "core/system/starts_with.h"
#include "server/ros/raw_message.h"
#include "server/ros/stamp.h"
#include "urdf/segments.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::size_t kLongestFrameName = 255;  // bytes

// Null: nothing.
const char* WhatIsWrong(const geometry_msgs::TransformStamped& stamped) {
  const auto& p = stamped.transform.translation;
  const auto& q = stamped.transform.rotation;
  const double norm = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  constexpr double kMaxOff = 0.01;
  if (stamped.child_frame_id.empty() || stamped.header.frame_id.empty()) return "without a name";
  if (std::max(stamped.child_frame_id.size(), stamped.header.frame_id.size()) > kLongestFrameName) {
    return "with a name that is too long";
  }
  if (stamped.child_frame_id == stamped.header.frame_id) return "whose parent is itself";
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z) || !std::isfinite(norm)) {
    return "with a number that is not finite";
  }
  return std::abs(norm - 1) < kMaxOff ? nullptr : "with a quaternion that is not of unit length";
}

// tf2 refuses what is older than all that it keeps of a frame. Once nothing else comes of it, the
// clock of its sender was set back: a bag that is played again, a simulator that was started over,
// one message of the future.
constexpr int kTooOldForAJump = 20;
const ros::Duration kKept(tf2::BufferCore::DEFAULT_CACHE_TIME);
constexpr std::size_t kMostOfName = 100;  // bytes, in a line of the log
constexpr char kTooOld[] = "that is older than all that is kept";

std::string_view WithoutModel(std::string_view frame, const std::string& model) {
  const bool has_model =
      frame.size() > model.size() + 1 && frame[model.size()] == '_' && StartsWith(frame, model);
  return has_model ? frame.substr(model.size() + 1) : frame;
}

// The link of the person that a frame hangs on, as a handle that is fixed to a hand.
std::optional<int> SegmentAbove(const std::string& frame, const std::string& model,
                                const TfTree& tf) {
  constexpr int kDeepest = 1000;  // TF may have a loop
  const std::string* above = &frame;
  for (int depth = 0; depth < kDeepest && !above->empty(); ++depth) {
    for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
      if (*above == urdf::LinkName(model, segment)) return segment;
    }
    const auto found = tf.frames().find(*above);
    if (found == tf.frames().end()) break;
    above = &found->second.parent;
  }
  return std::nullopt;
}

}  // namespace

TfTree::TfTree() {
  // tf2 prints a line for each transform that it refuses; who asks is told by Add().
  console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);
}

const char* TfTree::Take(const geometry_msgs::TransformStamped& transform, bool is_static) {
  if (const char* const wrong = WhatIsWrong(transform)) return wrong;
  const std::string frame = WithoutSlash(transform.child_frame_id);
  // tf2 keeps every name for good.
  if (frames_.size() >= kMostFrameNames && frames_.count(frame) == 0) return "of a further frame";
  if (is_static) {
    if (!buffer_.setTransform(transform, "/tf", true)) return kTooOld;
    Note(frame, transform);
    return nullptr;
  }
  const auto known = moving_.find(frame);
  const bool is_known = known != moving_.end(),
             is_taken = buffer_.setTransform(transform, "/tf", false);
  const ros::Time& stamp = transform.header.stamp;
  const bool is_too_old =
      !is_taken && (!is_known || known->second.newest.header.stamp - stamp >= kKept);
  if (is_too_old && (!is_known || ++known->second.too_old_in_a_row < kTooOldForAJump)) {
    return kTooOld;
  }
  if (is_too_old || (is_known && IsSetBack(known->second, stamp))) {
    SetBack();
    if (!buffer_.setTransform(transform, "/tf", false)) return kTooOld;
  } else if (!is_taken) {  // the same again, as of a simulator that pauses
    known->second.too_old_in_a_row = 0;
    return nullptr;
  }
  Moving& moving = moving_.try_emplace(frame, Moving{{}, 0, 0, round_}).first->second;
  moving.too_old_in_a_row = 0;
  if (!(transform.header.stamp < moving.newest.header.stamp)) moving.newest = transform;
  Note(frame, transform);
  return nullptr;
}

// Of a bag that is shorter than what tf2 keeps, and played in a loop, the newest transforms would
// stay those of the last round: tf2 has the others already. Once one frame has shown it, others
// need one transform. Two senders of one frame, one of them late, take turns.
bool TfTree::IsSetBack(Moving& moving, const ros::Time& stamp) {
  constexpr int kBehindForAJump = 5;
  const ros::Duration kBehind(0.5);
  if (moving.newest.header.stamp - stamp <= kBehind) {
    moving.behind_in_a_row = 0;
    moving.round = round_;
    return false;
  }
  ++moving.behind_in_a_row;
  if (moving.round != round_) return true;
  if (moving.behind_in_a_row < kBehindForAJump) return false;
  ++round_;
  return true;
}

template <class Stays>
void TfTree::ForgetUnless(const Stays& stays) {
  buffer_.clear();  // static ones stay
  for (auto each = moving_.begin(); each != moving_.end();) {
    Moving& moving = each->second;
    if (stays(moving)) {
      buffer_.setTransform(moving.newest, "/tf", false);
      moving.too_old_in_a_row = moving.behind_in_a_row = 0;
      ++each;
    } else {
      frames_.erase(each->first);
      each = moving_.erase(each);
    }
  }
}

// The time of the others goes on.
void TfTree::SetBack() {
  ForgetUnless([](const Moving& moving) {
    return moving.too_old_in_a_row == 0 && moving.behind_in_a_row == 0;
  });
}

void TfTree::StartAgain(std::int64_t now_nanos) {
  constexpr std::int64_t kJustNanos = 100 * kNanosPerMilli;
  ForgetUnless([&](const Moving& moving) {
    return ToNanos(moving.newest.header.stamp) <= now_nanos + kJustNanos;
  });
}

void TfTree::Note(const std::string& frame, const geometry_msgs::TransformStamped& transform) {
  const auto moving = moving_.find(frame);
  TreeFrame& known = frames_[frame];
  known.name = frame;
  known.parent = WithoutSlash(transform.header.frame_id);
  known.newest_nanos = moving == moving_.end() ? 0 : ToNanos(moving->second.newest.header.stamp);
  frames_.try_emplace(known.parent, TreeFrame{known.parent, "", 0});
}

std::vector<Refusal> TfTree::Add(const tf2_msgs::TFMessage& message, bool is_static) {
  constexpr std::size_t kMostSkipped = 1000;
  std::vector<Refusal> all;
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    const char* const why = Take(transform, is_static);
    if (why == nullptr) continue;
    if (skipped_.size() < kMostSkipped && transform.child_frame_id.size() <= kLongestFrameName) {
      skipped_[WithoutSlash(transform.child_frame_id)] = why;
    }
    const bool is_known =
        std::any_of(all.begin(), all.end(), [&](const Refusal& each) { return each.kind == why; });
    if (is_known) continue;
    all.push_back({why, fmt::format("a transform {}: '{}' in '{}'", why,
                                    transform.child_frame_id.substr(0, kMostOfName),
                                    transform.header.frame_id.substr(0, kMostOfName))});
  }
  return all;
}

std::string TfTree::WhySkipped(const std::string& frame) const {
  const auto found = skipped_.find(frame);
  return found == skipped_.end() || frames_.count(frame) > 0 ? "" : found->second;
}

std::optional<FramePlace> TfTree::Find(const std::string& target, const std::string& frame,
                                       std::int64_t stamp_nanos) const {
  for (const ros::Time& time : {ToRosTime(stamp_nanos), ros::Time(0)}) {
    if (!buffer_.canTransform(target, frame, time)) continue;
    try {
      const auto found = buffer_.lookupTransform(target, frame, time);
      const auto& p = found.transform.translation;
      const auto& q = found.transform.rotation;
      const urdf::Pose pose{{p.x, p.y, p.z}, Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized()};
      const std::int64_t newest = ToNanos(found.header.stamp);  // 0: it always holds
      return FramePlace{pose, newest != 0 && newest < stamp_nanos};
    } catch (const tf2::TransformException&) {  // although it reported the transform as available
    }
  }
  return std::nullopt;
}

std::optional<FoundFrame> FindFrame(const std::string& frame, std::int64_t stamp_nanos,
                                    const std::string& reference_frame, const std::string& model,
                                    const BodyNow& body, const TfTree& tf) {
  const std::size_t start =
      !frame.empty() && frame.front() == '/' ? 1 : 0;  // as old nodes write it
  const std::string name = frame.substr(start);
  if (name == reference_frame) return FoundFrame{{}, true};
  const std::string_view link = WithoutModel(name, model);
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    const urdf::SegmentInfo& info = urdf::kSegments[At(segment)];
    if (link == info.link_name || link == info.mvn_name) {
      return FoundFrame{body.links[At(segment)], true};
    }
  }
  if (name.empty() || !tf.Knows(name)) return std::nullopt;
  if (const auto place = tf.Find(reference_frame, name, stamp_nanos)) {
    return FoundFrame{place->pose, false, place->is_early};
  }
  const std::optional<int> segment = SegmentAbove(name, model, tf);
  if (!segment) return std::nullopt;
  const auto in_link = tf.Find(urdf::LinkName(model, *segment), name, stamp_nanos);
  if (!in_link) return std::nullopt;
  const urdf::Pose& link_pose = body.links[At(*segment)];
  const urdf::Pose& in_hand = in_link->pose;
  return FoundFrame{{link_pose.position + link_pose.orientation * in_hand.position,
                     link_pose.orientation * in_hand.orientation},
                    false,
                    in_link->is_early};
}

}  // namespace kinescope::ros_bridge
