#include "server/ros/joint_loads.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include "core/system/starts_with.h"
#include "core/unknown.h"
#include "server/ros/convert.h"
#include "server/ros/names.h"
#include "server/ros/stamp.h"

namespace kinescope::ros_bridge {
namespace {

void Copy(const Eigen::Vector3d& from, boost::array<double, 3>& to) {
  std::copy(from.data(), from.data() + 3, to.begin());
}

void Fill(const JointLoad& load, kinescope_ros::JointLoad& out) {
  out.joint = urdf::kJoints[At(load.joint)].mvn_name;
  Copy(load.moment, out.moment);
  Copy(load.force, out.force);
  out.ratio = load.ratio;
  out.shown_ratio = load.shown_ratio;
  out.load_class = static_cast<std::uint8_t>(load.load_class);
  out.channel = load.channel;
  out.channel_moment = load.deciding_moment;
  out.capacity = load.capacity;
  out.valid = load.load_class != LoadClass::kUnknown;
  out.reason = load.reason;
  out.source =
      load.is_external ? kinescope_ros::JointLoad::EXTERNAL : kinescope_ros::JointLoad::COMPUTED;
}

// Letters and digits in lower case, so that "right_ball_foot", "RightBallFoot" and "rightballfoot"
// are equal.
std::string Plain(std::string_view text) {
  std::string plain;
  for (const char c : text) {
    if (c != '_') plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return plain;
}

struct PlainNames {
  std::array<std::string, urdf::kJointCount> ros, mvn, newer_mvn;
  PlainNames() {
    for (std::size_t joint = 0; joint < ros.size(); ++joint) {
      ros[joint] = Plain(urdf::kJoints[joint].ros_name);
      mvn[joint] = newer_mvn[joint] = Plain(urdf::kJoints[joint].mvn_name);
      if (const auto at = mvn[joint].find("c7shoulder"); at != std::string::npos) {
        newer_mvn[joint].replace(at, 2, "t4");
      }
    }
  }
  int Find(const std::string& plain) const {
    for (int joint = 0; joint < urdf::kJointCount; ++joint) {
      if (plain == ros[At(joint)] || plain == mvn[At(joint)] || plain == newer_mvn[At(joint)]) {
        return joint;
      }
    }
    return -1;
  }
};

}  // namespace

void FillJointLoads(const PersonState& person, const std::string& reference_frame,
                    kinescope_ros::JointLoadArray& message) {
  const BodyForces& forces = person.forces;
  message.header.stamp = StampOf(person.sample);
  message.header.frame_id = reference_frame;
  message.metric = static_cast<std::uint8_t>(forces.metric);
  message.loads.resize(person.loads.size());
  for (std::size_t i = 0; i < person.loads.size(); ++i) Fill(person.loads[i], message.loads[i]);
  Set(message.cop, person.cop.value_or(Eigen::Vector3d::Constant(kUnknown)));
  message.cop_measured = person.cop && forces.ground_is_measured;
  message.dynamic = forces.is_dynamic;
  message.why_static = forces.why_static;
  message.why_other_metric = forces.why_other_metric;
  message.body_mass = forces.body_mass_kg;
  message.body_mass_assumed = forces.body_mass_is_assumed;
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    message.held_mass[side] = forces.hands[side].mass_kg;
  }
  message.l5_s1_compression = forces.lumbar ? forces.lumbar->compression : kUnknown;
  message.l5_s1_shear = forces.lumbar ? forces.lumbar->shear : kUnknown;
  message.margin_of_stability = forces.margin_of_stability.value_or(kUnknown);
  message.com_minus_mvn = forces.com_minus_mvn ? forces.com_minus_mvn->norm() : kUnknown;
}

NamedJoint FindNamedJoint(std::string_view name) {
  constexpr std::size_t kLongest = 128;  // names are untrusted
  NamedJoint found;
  if (const std::size_t slash = name.rfind('/'); slash != std::string_view::npos) {
    name.remove_prefix(slash + 1);
  }
  if (name.size() > kLongest) return found;
  std::string_view rest = name;
  const std::size_t last = rest.rfind('_');
  const std::string axis = Plain(last == std::string_view::npos ? "" : rest.substr(last + 1));
  found.is_rot = axis.size() == 4 && StartsWith(axis, "rot");
  const char letter = axis.size() == 1 || found.is_rot ? axis.back() : '\0';
  if (letter >= 'x' && letter <= 'z') {
    found.axis = letter - 'x';
    rest = rest.substr(0, last);
  } else {
    found.is_rot = false;
  }
  static const PlainNames names;
  while (true) {  // the name of a model may precede it, with further underscores
    found.joint = names.Find(Plain(rest));
    const std::size_t next = rest.find('_');
    if (found.joint >= 0 || next == std::string_view::npos) return found;
    rest.remove_prefix(next + 1);
  }
}

}  // namespace kinescope::ros_bridge
