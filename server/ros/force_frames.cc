#include "server/ros/force_frames.h"

#include <tf2/exceptions.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/system/starts_with.h"
#include "server/ros/stamp.h"
#include "urdf/segments.h"

namespace kinescope::ros_bridge {
namespace {

bool IsGood(const geometry_msgs::TransformStamped& stamped) {
  const auto& p = stamped.transform.translation;
  const auto& q = stamped.transform.rotation;
  const double norm = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  constexpr double kMaxOff = 0.01;
  return !stamped.child_frame_id.empty() && !stamped.header.frame_id.empty() &&
         stamped.child_frame_id != stamped.header.frame_id && std::isfinite(p.x) &&
         std::isfinite(p.y) && std::isfinite(p.z) && std::abs(norm - 1) < kMaxOff;
}

// tf2 refuses what is older than all that it keeps. Once nothing else comes, the clock of the
// senders was set back: a bag that is played again, a simulator that was started over.
constexpr int kTooOldForAJump = 20;

std::string_view WithoutModel(std::string_view frame, const std::string& model) {
  const bool has_model =
      frame.size() > model.size() + 1 && frame[model.size()] == '_' && StartsWith(frame, model);
  return has_model ? frame.substr(model.size() + 1) : frame;
}

}  // namespace

bool TfTree::Take(const geometry_msgs::TransformStamped& transform, bool is_static) {
  if (!IsGood(transform)) return false;
  const auto newest = newest_.find(transform.child_frame_id);
  const bool is_known = newest != newest_.end() && newest->second == transform.header.stamp;
  if (is_known && !is_static) return true;
  if (buffer_.setTransform(transform, "/tf", is_static)) {
    if (is_static) return true;
    too_old_in_a_row_ = 0;
    ros::Time& taken = newest_[transform.child_frame_id];
    taken = std::max(taken, transform.header.stamp);
    return true;
  }
  if (++too_old_in_a_row_ < kTooOldForAJump) return false;
  buffer_.clear();  // static ones stay
  newest_.clear();
  too_old_in_a_row_ = 0;
  return buffer_.setTransform(transform, "/tf", is_static);
}

int TfTree::Add(const tf2_msgs::TFMessage& message, bool is_static) {
  return static_cast<int>(std::count_if(
      message.transforms.begin(), message.transforms.end(),
      [&](const geometry_msgs::TransformStamped& each) { return !Take(each, is_static); }));
}

std::vector<TreeFrame> TfTree::frames() const {
  std::vector<std::string> names;
  buffer_._getFrameStrings(names);
  std::vector<TreeFrame> all;
  for (std::string& name : names) {
    TreeFrame frame;
    if (buffer_._getParent(name, ros::Time(0), frame.parent)) {
      ros::Time newest;
      buffer_._getLatestCommonTime(buffer_._lookupFrameNumber(frame.parent),
                                   buffer_._lookupFrameNumber(name), newest, nullptr);
      frame.newest_nanos = ToNanos(newest);
    } else {
      frame.parent.clear();
    }
    frame.name = std::move(name);
    all.push_back(std::move(frame));
  }
  return all;
}

std::optional<urdf::Pose> TfTree::Find(const std::string& target, const std::string& frame,
                                       std::int64_t stamp_nanos) const {
  for (const ros::Time& time : {ToRosTime(stamp_nanos), ros::Time(0)}) {
    if (!buffer_.canTransform(target, frame, time)) continue;
    try {
      const auto found = buffer_.lookupTransform(target, frame, time);
      const auto& p = found.transform.translation;
      const auto& q = found.transform.rotation;
      return urdf::Pose{{p.x, p.y, p.z}, Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized()};
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
  if (name.empty()) return std::nullopt;
  if (const auto pose = tf.Find(reference_frame, name, stamp_nanos)) {
    return FoundFrame{*pose, false};
  }
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {  // a handle fixed to a hand
    const auto in_link = tf.Find(urdf::LinkName(model, segment), name, stamp_nanos);
    if (!in_link) continue;
    const urdf::Pose& link_pose = body.links[At(segment)];
    return FoundFrame{{link_pose.position + link_pose.orientation * in_link->position,
                       link_pose.orientation * in_link->orientation},
                      false};
  }
  return std::nullopt;
}

}  // namespace kinescope::ros_bridge
