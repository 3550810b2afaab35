/// Names and order of one person's messages, as in xsens_mvn_ros. Made once per model, so that
/// publishing a sample creates no strings. Pure functions and constant values, any thread.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "core/finger_and_prop_segments.h"
#include "urdf/human_urdf.h"
#include "urdf/segments.h"

namespace kinescope::ros_bridge {

using urdf::At;

/// Joints and segments in the alphabetical order of their ROS names: the order in the messages.
const std::array<int, urdf::kJointCount>& JointsByName();
const std::array<int, urdf::kSegmentCount>& SegmentsByName();

struct PersonNames {
  explicit PersonNames(const std::string& model_name);  // without gloves and props
  explicit PersonNames(const urdf::HumanModel& human);

  /// `<model>_<joint>_{x,y,z}`, three for each of JointsByName(). Then, if the model has them:
  /// three for each finger segment of the left and of the right hand, and six for each prop in the
  /// order of their chain.
  std::vector<std::string> joints;
  /// `<model>_<link>`, by urdf::Segment.
  std::array<std::string, urdf::kSegmentCount> links;
  /// The two massless links that the URDF has inside joint j: after its rotation about y, and after
  /// that about x. By urdf::Joint.
  std::array<std::array<std::string, 2>, urdf::kJointCount> between;
  /// `<model>_left_second_mp`, `<model>_prop1`, indexed as FingerAndPropSegments.
  std::array<std::string, kFingerAndPropCount> fingers_and_props;
  /// The massless links before each of these, in the order of the chain: two for a finger, five for
  /// a prop. Empty if the model has none. Indexed as FingerAndPropSegments.
  std::array<std::vector<std::string>, kFingerAndPropCount> before_fingers_and_props;
  /// `<model>_<link>_imu`: the frame of the suit's sensor on a segment, by urdf::Segment.
  std::array<std::string, urdf::kSegmentCount> sensors;
  std::string model;
};

/// "LeftSecondMP" in the spelling of xsens_mvn_ros: "left_second_mp".
std::string AsSnakeCase(const std::string& text);

/// The name of a topic as graphs have it, which bags do not always: "tf" becomes "/tf".
std::string WithSlash(const std::string& topic);
/// "/kinescope/anna/" of "/kinescope/anna/joint_loads".
std::string NamespaceOf(const std::string& topic);
/// As people read it: "plan" for "/plan".
std::string WithoutSlashes(const std::string& topic);

/// `text` as one element of a ROS name: letters, digits and _, beginning with a letter.
std::string AsRosName(const std::string& text);

}  // namespace kinescope::ros_bridge
