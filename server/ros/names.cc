#include "server/ros/names.h"

#include <algorithm>
#include <numeric>

#include "urdf/human_urdf.h"

namespace kinescope::ros_bridge {
namespace {

template <std::size_t n, class NameOf>
std::array<int, n> SortedBy(const NameOf& name_of) {
  std::array<int, n> order{};
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return name_of(a) < name_of(b); });
  return order;
}

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool IsUpper(char c) { return c >= 'A' && c <= 'Z'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

const std::array<int, urdf::kJointCount>& JointsByName() {
  static const auto order =
      SortedBy<urdf::kJointCount>([](int joint) { return urdf::kJoints[At(joint)].ros_name; });
  return order;
}

const std::array<int, urdf::kSegmentCount>& SegmentsByName() {
  static const auto order = SortedBy<urdf::kSegmentCount>(
      [](int segment) { return urdf::kSegments[At(segment)].link_name; });
  return order;
}

PersonNames::PersonNames(const std::string& model_name) : model(model_name) {
  for (int prop = 0; prop < kMaxProps; ++prop) {
    fingers_and_props[At(PropIndex(prop))] = urdf::PropLinkName(model, prop);
  }
  for (const urdf::Side side : {urdf::kLeft, urdf::kRight}) {
    for (int finger = 0; finger < kFingersPerHand; ++finger) {
      fingers_and_props[At(FingerIndex(side, finger))] = urdf::FingerLinkName(model, side, finger);
    }
  }
  for (const int joint : JointsByName()) {
    for (int axis = 0; axis < 3; ++axis) {
      joints.push_back(urdf::JointName(model_name, joint, axis));
    }
  }
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    links[At(segment)] = urdf::LinkName(model_name, segment);
    sensors[At(segment)] = links[At(segment)] + "_imu";
  }
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    for (const int axis : {1, 0}) {
      between[At(joint)][At(1 - axis)] = urdf::LinkInside(urdf::JointName(model_name, joint, axis));
    }
  }
}

PersonNames::PersonNames(const urdf::HumanModel& human) : PersonNames(human.model_name) {
  for (const urdf::Side side : {urdf::kLeft, urdf::kRight}) {
    if (!human.gloves[side]) continue;
    for (int finger = 0; finger < kFingersPerHand; ++finger) {
      for (int axis = 0; axis < 3; ++axis) {
        joints.push_back(urdf::FingerJointName(model, side, finger, axis));
      }
      for (const int axis : {1, 0}) {
        before_fingers_and_props[At(FingerIndex(side, finger))].push_back(
            urdf::LinkInside(urdf::FingerJointName(model, side, finger, axis)));
      }
    }
  }
  for (int prop = 0; prop < kMaxProps; ++prop) {
    if (!human.props.test(At(prop))) continue;
    const auto chain = urdf::PropJointNames(model, prop);
    joints.insert(joints.end(), chain.begin(), chain.end());
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      before_fingers_and_props[At(PropIndex(prop))].push_back(urdf::LinkInside(chain[i]));
    }
  }
}

std::string AsSnakeCase(const std::string& text) {
  std::string name;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins_word =
        IsUpper(text[i]) && i > 0 && !IsUpper(text[i - 1]) && text[i - 1] != '_';
    if (begins_word) name += '_';
    name += IsUpper(text[i]) ? static_cast<char>(text[i] - 'A' + 'a') : text[i];
  }
  return name;
}

std::string NamespaceOf(const std::string& topic) { return topic.substr(0, topic.rfind('/') + 1); }

std::string WithSlash(const std::string& topic) {
  return topic.empty() || topic.front() == '/' ? topic : "/" + topic;
}

std::string WithoutSlashes(const std::string& topic) {
  return topic.substr(std::min(topic.find_first_not_of('/'), topic.size()));
}

std::string AsRosName(const std::string& text) {
  std::string name;
  for (const char c : text) name += IsLetter(c) || IsDigit(c) ? c : '_';
  if (name.empty() || !IsLetter(name.front())) name.insert(0, "person_");
  return name;
}

}  // namespace kinescope::ros_bridge
