/// Names and order of what one person's messages carry, as the seed bridge has them. Made once per
/// model, so that publishing a sample makes no string.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/extra_segments.h"
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

  /// `<model>_<joint>_{x,y,z}`, three for each of JointsByName(); then, where the model has them,
  /// three for each finger's segment of the left and of the right hand, and the six of each prop in
  /// the order of their chain.
  std::vector<std::string> joints;
  /// `<model>_<link>`, by urdf::Segment.
  std::array<std::string, urdf::kSegmentCount> links;
  /// The two links without mass that the URDF has inside joint j: after its turn about y, and after
  /// its turn about x. By urdf::Joint.
  std::array<std::array<std::string, 2>, urdf::kJointCount> between;
  /// `<model>_left_second_mp`, `<model>_prop1`, by ExtraSegments' index.
  std::array<std::string, kExtraCount> extra;
  /// Likewise, the links without mass before it, in the order of the chain: two of a finger, five
  /// of a prop. Empty where the model has none.
  std::array<std::vector<std::string>, kExtraCount> before_extra;
  std::string model;
};

/// "LeftSecondMP" as the seed would write it: "left_second_mp".
std::string AsSnakeCase(const std::string& text);

/// `text` as one element of a ROS name: letters, digits and _, beginning with a letter.
std::string AsRosName(const std::string& text);

bool EndsWith(std::string_view text, std::string_view ending);

}  // namespace kinescope::ros_bridge
