/// Converts what the suit itself measures and knows to ROS: its sensors, the landmarks of the body
/// and its clocks. Pure: no node, no clock; any thread.
#pragma once

#include <kinescope/LandmarkArray.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/MagneticField.h>
#include <sensor_msgs/TimeReference.h>
#include <tf2_msgs/TFMessage.h>

#include <bitset>
#include <string>

#include "core/scene_state.h"
#include "server/ros/names.h"

namespace kinescope::ros_bridge {

/// Of the sensor on `segment`, which the sample must have, in the frame of that sensor (names):
/// orientation in the reference frame, acceleration with gravity, m/s^2, and angular velocity,
/// rad/s. Where the suit does not send the latter two, the first element of their covariances is
/// -1, as sensor_msgs/Imu has it; other covariances are 0: unknown.
void FillImu(const PersonState& person, const PersonNames& names, int segment,
             sensor_msgs::Imu& message);

/// As FillImu. MVN scales the field to about 1 where the suit was calibrated: it is not in tesla.
void FillMagneticField(const PersonState& person, const PersonNames& names, int segment,
                       sensor_msgs::MagneticField& message);

/// Adds the frame of each sensor in `sensors`, a child of the reference frame: turned as the sensor
/// is, at the origin of its segment, since MVN does not send where on it the sensor is.
void AddSensors(const PersonState& person, const PersonNames& names,
                const std::bitset<urdf::kSegmentCount>& sensors, const std::string& reference_frame,
                tf2_msgs::TFMessage& message);

/// The landmarks that came with the lengths of `model`, else those of its skeleton.
urdf::Landmarks LandmarksToPublish(const PersonModel& model);

void FillLandmarks(const PersonState& person, const PersonNames& names,
                   const urdf::Landmarks& landmarks, const std::string& reference_frame,
                   kinescope_ros::LandmarkArray& message);

/// The time since the suit's recording began, beside the stamp of the sample.
void FillTimeCode(const BodySample& sample, sensor_msgs::TimeReference& message);

/// MVN's own time of day (type 25), with the date that is nearest to the sample's stamp.
/// @pre sample.utc_millis_of_day
void FillUtc(const BodySample& sample, sensor_msgs::TimeReference& message);

}  // namespace kinescope::ros_bridge
