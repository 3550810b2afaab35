#include "server/ros/robot_frames.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

namespace kinescope::ros_bridge {
namespace {

using Eigen::Isometry3d;

constexpr std::size_t kMostNamedLinks = 4;  // links in a problem; the others are counted

Isometry3d Nowhere() {
  Isometry3d pose = Isometry3d::Identity();
  pose.matrix().setConstant(std::numeric_limits<double>::quiet_NaN());
  return pose;
}

bool IsSomewhere(const Isometry3d& pose) { return pose.matrix().allFinite(); }

Isometry3d ToIsometry(const urdf::Pose& pose) {
  Isometry3d isometry(pose.orientation.normalized());
  isometry.pretranslate(pose.position);
  return isometry;
}

bool IsSame(const Isometry3d& a, const Isometry3d& b) {
  return a.matrix() == b.matrix() || (!IsSomewhere(a) && !IsSomewhere(b));
}

// Of the links that would be seen.
std::string ProblemOf(const RobotState& robot, const std::vector<std::string>& frames) {
  std::vector<std::string> missing;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (robot.model->links[i].visuals.empty()) continue;
    ++seen;
    if (!IsSomewhere(robot.world_from_link[i])) missing.push_back(frames[i]);
  }
  if (missing.empty()) return "";
  const std::size_t count = missing.size();
  if (count > kMostNamedLinks) missing.resize(kMostNamedLinks);
  return fmt::format("robot '{}': {} of {} links have no place in TF: {}{}", robot.name, count,
                     seen, fmt::join(missing, ", "), count > kMostNamedLinks ? ", ..." : "");
}

}  // namespace

std::string JointStatesOf(const GraphRobot& robot) {
  return (robot.tf_prefix.empty() ? "" : "/" + robot.tf_prefix) + "/joint_states";
}

std::string FrameOfLink(const std::string& tf_prefix, const std::string& link) {
  return tf_prefix.empty() ? link : tf_prefix + "/" + link;
}

RobotFrames::RobotFrames(RobotState robot, const std::string& tf_prefix) : model_(robot.model) {
  std::unordered_map<std::string, std::size_t> links;
  for (std::size_t i = 0; i < model_->links.size(); ++i) {
    const std::string& name = model_->links[i].name;
    links[name] = i;
    frames_.push_back(FrameOfLink(tf_prefix, name));
    links_[frames_.back()] = i;
    parents_.push_back(i);
  }
  for (const urdf::RobotJoint& joint : model_->joints) {
    parents_[links.at(joint.child_link)] = links.at(joint.parent_link);
    if (joint.HasPosition()) moved_joints_.insert(joint.name);
  }
  has_frame_.assign(model_->links.size(), false);
  robot.moves = true;
  robot.bounds.setEmpty();
  robot.world_from_link.assign(model_->links.size(), Nowhere());
  robot.problem = ProblemOf(robot, frames_);
  now_ = std::make_shared<const RobotState>(std::move(robot));
}

bool RobotFrames::Take(const sensor_msgs::JointState& message) {
  bool is_used = false;
  const std::size_t count = std::min(message.name.size(), message.position.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(message.position[i]) || moved_joints_.count(message.name[i]) == 0) continue;
    positions_[message.name[i]] = message.position[i];
    is_used = true;
  }
  if (is_used) chained_ = urdf::PlaceLinks(*model_, positions_);
  return is_used;
}

bool RobotFrames::Place(const FindFrame& find) {
  std::vector<Isometry3d> placed(model_->links.size(), Nowhere());
  for (std::size_t link = 0; link < placed.size(); ++link) {  // parents before children
    const std::size_t parent = parents_[link];
    const std::optional<urdf::Pose> found = find(frames_[link]);
    has_frame_[link] = found.has_value();
    if (found) {
      placed[link] = ToIsometry(*found);
    } else if (chained_.empty()) {
      continue;
    } else if (parent == link) {
      placed[link] = Isometry3d::Identity();
    } else {
      placed[link] = placed[parent] * chained_[parent].inverse() * chained_[link];
    }
  }
  if (std::equal(placed.begin(), placed.end(), now_->world_from_link.begin(),
                 now_->world_from_link.end(), IsSame)) {
    return false;
  }
  RobotState next = *now_;
  next.world_from_link = std::move(placed);
  next.problem = ProblemOf(next, frames_);
  now_ = std::make_shared<const RobotState>(std::move(next));
  return true;
}

std::string RobotFrames::FirstMissing() const {
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const bool is_seen = !model_->links[i].visuals.empty();
    if (is_seen && !IsSomewhere(now_->world_from_link[i])) return frames_[i];
  }
  return "";
}

std::optional<urdf::Pose> RobotFrames::FindChained(const std::string& frame) const {
  const auto link = links_.find(frame);
  if (link == links_.end() || has_frame_[link->second]) return std::nullopt;
  const Isometry3d& world_from_link = now_->world_from_link[link->second];
  if (!IsSomewhere(world_from_link)) return std::nullopt;
  return urdf::Pose{world_from_link.translation(), Eigen::Quaterniond(world_from_link.linear())};
}

std::optional<urdf::Pose> FindChainedOf(const std::vector<const RobotFrames*>& robots,
                                        const std::string& frame) {
  for (const RobotFrames* const robot : robots) {
    if (auto found = robot->FindChained(frame)) return found;
  }
  return std::nullopt;
}

}  // namespace kinescope::ros_bridge
