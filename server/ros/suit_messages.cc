#include "server/ros/suit_messages.h"

#include <cmath>

#include "core/system/clocks.h"
#include "server/ros/convert.h"
#include "server/ros/stamp.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::int64_t kNanosPerDay = 24 * 3600 * kNanosPerSecond;

void SetHeader(const PersonState& person, const std::string& frame, std_msgs::Header& header) {
  header.stamp = StampOf(person.sample);
  header.frame_id = frame;
}

}  // namespace

void FillImu(const PersonState& person, const PersonNames& names, int segment,
             sensor_msgs::Imu& message) {
  const TrackerState& tracker = person.sample.trackers[At(segment)];
  SetHeader(person, names.sensors[At(segment)], message.header);
  Set(message.orientation, tracker.orientation);
  Set(message.angular_velocity, tracker.angular_velocity);
  Set(message.linear_acceleration, tracker.acceleration);
  const double known = tracker.has_rates ? 0 : -1;
  message.angular_velocity_covariance[0] = known;
  message.linear_acceleration_covariance[0] = known;
}

void FillMagneticField(const PersonState& person, const PersonNames& names, int segment,
                       sensor_msgs::MagneticField& message) {
  SetHeader(person, names.sensors[At(segment)], message.header);
  Set(message.magnetic_field, person.sample.trackers[At(segment)].magnetic_field);
}

void AddSensors(const PersonState& person, const PersonNames& names,
                const std::bitset<urdf::kSegmentCount>& sensors, const std::string& reference_frame,
                tf2_msgs::TFMessage& message) {
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    if (!sensors.test(At(segment))) continue;
    geometry_msgs::TransformStamped out;
    SetHeader(person, reference_frame, out.header);
    out.child_frame_id = names.sensors[At(segment)];
    Set(out.transform.translation, person.sample.segments[At(segment)].position);
    Set(out.transform.rotation, person.sample.trackers[At(segment)].orientation);
    message.transforms.push_back(std::move(out));
  }
}

urdf::Landmarks LandmarksToPublish(const PersonModel& model) {
  return model.landmarks.empty() ? urdf::LandmarksOf(model.human.skeleton) : model.landmarks;
}

void FillLandmarks(const PersonState& person, const PersonNames& names,
                   const urdf::Landmarks& landmarks, const std::string& reference_frame,
                   kinescope_ros::LandmarkArray& message) {
  SetHeader(person, reference_frame, message.header);
  message.landmarks.resize(landmarks.size());
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const urdf::Landmark& landmark = landmarks[i];
    const SegmentState& segment = person.sample.segments[At(landmark.segment)];
    kinescope_ros::Landmark& out = message.landmarks[i];
    out.name = landmark.name;
    out.link = names.links[At(landmark.segment)];
    Set(out.position, segment.position + segment.orientation * landmark.in_segment);
    Set(out.in_link, urdf::SegmentFromLink(landmark.segment).conjugate() * landmark.in_segment);
  }
}

void FillTimeCode(const BodySample& sample, sensor_msgs::TimeReference& message) {
  message.header.stamp = StampOf(sample);
  message.time_ref = ToRosTime(sample.time_code_millis * kNanosPerMilli);
  message.source = "mvn_time_code";
}

void FillUtc(const BodySample& sample, sensor_msgs::TimeReference& message) {
  message.header.stamp = StampOf(sample);
  const std::int64_t of_day = *sample.utc_millis_of_day * kNanosPerMilli;
  const std::int64_t days = std::llround(static_cast<double>(sample.stamp_nanos - of_day) /
                                         static_cast<double>(kNanosPerDay));
  message.time_ref = ToRosTime(days * kNanosPerDay + of_day);
  message.source = "mvn_utc";
}

}  // namespace kinescope::ros_bridge
