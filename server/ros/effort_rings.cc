#include "server/ros/effort_rings.h"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "server/ros/point_colors.h"
#include "server/ros/robot_frames.h"
#include "server/ros/shown_parts.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using visualization_msgs::Marker;

constexpr double kLeastRadius = 0.05;                  // m, and as a share of the largest effort
constexpr double kUsualScale = 1, kUsualWidth = 0.02;  // m
constexpr double kLargestRadius = 100;                 // m

// The turn that takes the axis to z, where RViz draws the ring.
Quaterniond RingTurn(const Vector3d& axis) {
  const Vector3d about = axis.cross(Vector3d::UnitZ());
  if (about.norm() <= 1e-9 * axis.norm()) return Quaterniond::Identity();
  const double angle = std::atan2(about.norm(), axis.z());
  return Quaterniond(Eigen::AngleAxisd(angle, about.normalized()));
}

// 0: no effort. Up to 1 where the largest effort is known, else in N·m.
double ShareOf(double effort, const urdf::RobotJoint& joint) {
  const double most = joint.limits ? joint.limits->effort : 0;
  return most != 0 ? std::min(std::abs(effort) / std::abs(most), 1.0) : std::abs(effort);
}

std_msgs::ColorRGBA RingColor(double share, const ShownStyle& style) {
  ShownStyle rainbow;
  rainbow.alpha = style.alpha;
  rainbow.scale = PointScale{};
  rainbow.scale->from = 0;
  rainbow.scale->to = 1;
  rainbow.scale->is_inverted = true;
  return In(style, ColorsOf({share}, rainbow).front());
}

void AddRing(const std_msgs::Header& header, int id, double effort, const urdf::RobotJoint& joint,
             const ShownStyle& style, ShownMarkers& markers) {
  constexpr int kParts = 32, kDrawn = 30;
  const double width = style.width_m.value_or(kUsualWidth);
  const double share = ShareOf(effort, joint) + kLeastRadius;
  const double radius =
      std::min(kLeastRadius + share * style.size_m.value_or(kUsualScale) / 2, kLargestRadius);
  const std_msgs::ColorRGBA color = RingColor(share, style);
  const Quaterniond turn = RingTurn(joint.axis);
  const double forward = effort < 0 ? -1 : 1;
  Marker ring = MarkerOf(header, id, Marker::LINE_STRIP, color);
  ring.frame_locked = 1;
  ring.scale.x = width;
  for (int i = 0; i < kDrawn; ++i) {
    const double angle = 2 * M_PI * i / kParts;
    ring.points.push_back(
        PointAt(turn * Vector3d(forward * radius * std::sin(angle), radius * std::cos(angle), 0)));
  }
  Marker head = MarkerOf(header, id + 1, Marker::ARROW, color);
  head.frame_locked = 1;
  const Vector3d from(0, radius, 0);
  head.points = {PointAt(turn * from),
                 PointAt(turn * (from + Vector3d(-forward * 2 * width, 0, 0)))};
  head.scale.x = 2 * width;
  head.scale.y = 4 * width;
  head.scale.z = 2 * width;  // all of it
  markers.push_back(std::move(ring));
  markers.push_back(std::move(head));
}

bool HasRing(const urdf::RobotJoint& joint, double effort, const ShownStyle& style) {
  const std::vector<std::string>& hidden = style.frames.hidden;
  return joint.type == urdf::RobotJoint::Type::kRevolute && std::isfinite(effort) &&
         std::find(hidden.begin(), hidden.end(), joint.name) == hidden.end();
}

}  // namespace

void ShownJoints::Add(const std::shared_ptr<const urdf::RobotModel>& model,
                      const std::string& tf_prefix) {
  for (const urdf::RobotJoint& joint : model->joints) {
    const auto number = static_cast<int>(joints_.size());
    const std::shared_ptr<const urdf::RobotJoint> of_model(model, &joint);
    const std::string frame = FrameOfLink(tf_prefix, joint.child_link);
    const auto [known, is_new] =
        joints_.try_emplace(joint.name, ShownJoint{number, of_model, frame});
    // Of several robots that of RViz, whose display of efforts has no prefix.
    const ShownJoint& first = known->second;
    const bool has_prefix = first.frame != FrameOfLink("", first.joint->child_link);
    if (!is_new && has_prefix && tf_prefix.empty()) {
      known->second = ShownJoint{first.number, of_model, frame};
    }
  }
}

std::optional<ShownJoint> ShownJoints::Find(const std::string& name) const {
  const auto found = joints_.find(name);
  return found == joints_.end() ? std::nullopt : std::optional<ShownJoint>(found->second);
}

Taken<ShownMarkers> ToMarkers(const sensor_msgs::JointState& message, const FindJoint& find,
                              const ShownStyle& style) {
  if (message.name.empty()) return ShownMarkers{};
  if (message.effort.size() != message.name.size()) {
    return tl::unexpected(
        Refusal{"no efforts", fmt::format("joint states: {} names and {} efforts",
                                          message.name.size(), message.effort.size())});
  }
  ShownMarkers markers;
  bool is_known = false;
  for (std::size_t i = 0; i < message.name.size(); ++i) {
    const std::optional<ShownJoint> shown = find ? find(message.name[i]) : std::nullopt;
    if (!shown) continue;
    is_known = true;
    std_msgs::Header header;
    header.frame_id = shown->frame;
    const int id = 2 * shown->number;
    if (HasRing(*shown->joint, message.effort[i], style)) {
      AddRing(header, id, message.effort[i], *shown->joint, style, markers);
    } else {
      markers.push_back(Without(header, id));
      markers.push_back(Without(header, id + 1));
    }
  }
  if (is_known) return markers;
  Refusal refusal{"no such joint", "joint states: no robot that is shown has the joint '" +
                                       message.name[0] +
                                       "'; robots are shown by --robot, people have spheres for "
                                       "their loads"};
  refusal.may_come = true;
  return tl::unexpected(std::move(refusal));
}

}  // namespace kinescope::ros_bridge
