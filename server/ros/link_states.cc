#include "server/ros/link_states.h"

#include "server/ros/convert.h"
#include "server/ros/names.h"
#include "server/ros/stamp.h"

namespace kinescope::ros_bridge {

void FillLinkStates(const PersonState& person, const std::string& reference_frame,
                    xsens_mvn_ros_msgs::LinkStateArray& message) {
  message.header.stamp = StampOf(person.sample);
  message.header.frame_id = reference_frame;
  message.states.resize(urdf::kSegmentCount);
  std::size_t row = 0;
  for (const int segment : SegmentsByName()) {
    const urdf::Pose& link = person.links[At(segment)];
    const SegmentState& measured = person.sample.segments[At(segment)];
    xsens_mvn_ros_msgs::LinkState& out = message.states[row++];
    out.header.stamp = message.header.stamp;
    out.header.frame_id = urdf::kSegments[At(segment)].link_name;
    Set(out.pose.position, link.position);
    Set(out.pose.orientation, link.orientation);
    Set(out.twist.linear, measured.velocity);
    Set(out.twist.angular, measured.angular_velocity);
    Set(out.accel.linear, measured.acceleration);
    Set(out.accel.angular, measured.angular_acceleration);
  }
}

void FillPoint(const PersonState& person, const std::string& reference_frame,
               const Eigen::Vector3d& point, geometry_msgs::PointStamped& message) {
  message.header.stamp = StampOf(person.sample);
  message.header.frame_id = reference_frame;
  Set(message.point, point);
}

}  // namespace kinescope::ros_bridge
