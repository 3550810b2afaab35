/// Converts Eigen types to ROS types, element by element. Pure functions, any thread.
#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/Vector3.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace kinescope::ros_bridge {

template <class RosVector>  // geometry_msgs Point and Vector3
void Set(RosVector& out, const Eigen::Vector3d& v) {
  out.x = v.x();
  out.y = v.y();
  out.z = v.z();
}

inline void Set(geometry_msgs::Quaternion& out, const Eigen::Quaterniond& q) {
  out.w = q.w();
  out.x = q.x();
  out.y = q.y();
  out.z = q.z();
}

}  // namespace kinescope::ros_bridge
