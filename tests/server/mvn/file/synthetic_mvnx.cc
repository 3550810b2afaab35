#include "tests/server/mvn/file/synthetic_mvnx.h"

#include <cmath>
#include <cstdio>

#include "server/mvn/file/mvnx_source.h"
#include "urdf/kinematics.h"

namespace kinescope::mvn::testing {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

void Append(std::string& out, double number) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6f ", number);
  out += text.data();
}

void Append(std::string& out, const Vector3d& value) {
  for (const double number : value) Append(out, number);
}

void Append(std::string& out, const Quaterniond& value) {
  for (const double number : {value.w(), value.x(), value.y(), value.z()}) Append(out, number);
}

template <class Get>
std::string List(const char* name, const BodySample& sample, const Get& get) {
  std::string out = std::string("<") + name + ">";
  for (std::size_t i = 0; i < sample.segments.size(); ++i) Append(out, get(i, sample.segments[i]));
  return out + "</" + name + ">\n";
}

std::string Poses(int version, const BodySample& sample) {
  return List("orientation", sample,
              [version](std::size_t i, const SegmentState& segment) -> Quaterniond {
                if (version == 4) return segment.orientation;
                return segment.orientation * urdf::SegmentFromIsb(static_cast<int>(i));
              }) +
         List("position", sample,
              [](std::size_t, const SegmentState& segment) { return segment.position; });
}

std::string Frame(int version, double rate_hz, const BodySample& sample) {
  const double millis = sample.counter * 1000.0 / rate_hz;
  std::array<char, 160> head{};
  std::snprintf(head.data(), head.size(),
                "<frame time=\"%.0f\" index=\"%u\" ms=\"%.0f\" type=\"normal\">\n", millis,
                sample.counter, 1.6e12 + millis);
  std::string out = head.data() + Poses(version, sample);
  using S = SegmentState;
  if (sample.has_linear) {
    out += List("velocity", sample, [](std::size_t, const S& s) { return s.velocity; });
    out += List("acceleration", sample, [](std::size_t, const S& s) { return s.acceleration; });
  }
  if (sample.has_angular) {
    out +=
        List("angularVelocity", sample, [](std::size_t, const S& s) { return s.angular_velocity; });
    out += List("angularAcceleration", sample,
                [](std::size_t, const S& s) { return s.angular_acceleration; });
  }
  if (sample.streamed_angles_deg) {
    out += "<jointAngle>";
    for (const Vector3d& angles : *sample.streamed_angles_deg) Append(out, angles);
    out += "</jointAngle>\n";
  }
  if (sample.com) {
    out += "<centerOfMass>";
    Append(out, sample.com->position);
    if (sample.com->has_derivatives) {
      Append(out, sample.com->velocity);
      Append(out, sample.com->acceleration);
    }
    out += "</centerOfMass>\n";
  }
  return out + "</frame>\n";
}

std::string Point(int version, std::string_view label, const Vector3d& position) {
  const std::string tag = version == 4 ? "pos_b" : "pos_s";
  std::string out = "<point label=\"" + std::string(label) + "\"><" + tag + ">";
  Append(out, position);
  return out + "</" + tag + "></point>\n";
}

std::string Points(int version, const urdf::Skeleton& skeleton, int segment) {
  std::string out = Point(version, "pOrigin", Vector3d::Zero());
  const Quaterniond& turn = urdf::SegmentFromLink(segment);
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    if (urdf::ParentOf(joint) != segment) continue;
    std::string name(urdf::kJoints[static_cast<std::size_t>(joint)].mvn_name);
    if (version == 4 && name.find("C7Shoulder") != std::string::npos) {
      name.replace(name.find("C7"), 2, "T4");
    }
    const auto child = static_cast<std::size_t>(urdf::ChildOf(joint));
    out += Point(version, name, turn * skeleton.origin_in_parent[child]);
  }
  const auto end = [&](std::string_view label, const Vector3d& in_link) {
    out += Point(version, label, turn * in_link);
  };
  switch (segment) {
    case urdf::kHead: end("pTopOfHead", skeleton.head_top_in_head); break;
    case urdf::kRightHand: end("pRightTopOfHand", skeleton.finger_tip_in_hand[0]); break;
    case urdf::kLeftHand: end("pLeftTopOfHand", skeleton.finger_tip_in_hand[1]); break;
    case urdf::kRightFoot: end("pRightHeelFoot", skeleton.heel_in_foot[0]); break;
    case urdf::kLeftFoot: end("pLeftHeelFoot", skeleton.heel_in_foot[1]); break;
    case urdf::kRightToe: end("pRightToe", skeleton.toe_tip_in_toe[0]); break;
    case urdf::kLeftToe: end("pLeftToe", skeleton.toe_tip_in_toe[1]); break;
    default: break;
  }
  return out;
}

}  // namespace

std::string WriteMvnx(int version, double rate_hz, const urdf::Skeleton& skeleton,
                      const std::vector<BodySample>& samples) {
  std::string out =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<!-- <!DOCTYPE in a comment is no document type> -->\n"
      "<mvnx xmlns=\"http://www.xsens.com/mvn/mvnx\" version=\"" +
      std::to_string(version) +
      "\">\n<mvn version=\"synthetic\"/>\n"
      "<subject torsoColor=\"#4060ff\" label=\"Synthetic\" frameRate=\"" +
      std::to_string(rate_hz) + "\" segmentCount=\"23\">\n<segments>\n";
  for (int i = 0; i < urdf::kSegmentCount; ++i) {
    out += "<segment id=\"" + std::to_string(i + 1) + "\" label=\"" +
           std::string(urdf::kSegments[static_cast<std::size_t>(i)].mvn_name) + "\"><points>\n" +
           Points(version, skeleton, i) + "</points></segment>\n";
  }
  out += "</segments>\n<joints>\n";
  for (const urdf::JointInfo& joint : urdf::kJoints) {
    out +=
        "<joint label=\"" + std::string(joint.mvn_name) + "\"><connector1>a</connector1></joint>\n";
  }
  out += "</joints>\n<frames segmentCount=\"23\" jointCount=\"22\">\n";
  const std::vector<std::string> calibrations =
      version == 3 ? std::vector<std::string>{"npose", "tpose"}
                   : std::vector<std::string>{"identity", "tpose", "tpose-isb"};
  for (const std::string& type : calibrations) {
    out += "<frame time=\"0\" ms=\"0\" type=\"" + type + "\">" + Poses(version, BodySample()) +
           "</frame>\n";
  }
  for (const BodySample& sample : samples) out += Frame(version, rate_hz, sample);
  return out + "</frames>\n</subject>\n<securityCode code=\"0\"/>\n</mvnx>\n";
}

std::vector<BodySample> SwingingArms(const urdf::Skeleton& skeleton, int count) {
  std::vector<BodySample> samples;
  for (int frame = 0; frame < count; ++frame) {
    urdf::JointAngles angles{};
    angles.fill(Vector3d::Zero());
    angles[urdf::jRightShoulder].y() = -0.5 * std::sin(0.1 * frame);
    angles[urdf::jLeftShoulder].y() = 0.5 * std::sin(0.1 * frame);
    angles[urdf::jRightElbow].y() = -0.4;
    const urdf::Pose pelvis{urdf::NPoseOrigins(skeleton)[urdf::kPelvis], Quaterniond::Identity()};
    const urdf::LinkPoses links = urdf::ForwardKinematics(skeleton, pelvis, angles);
    BodySample sample;
    sample.counter = static_cast<std::uint32_t>(frame);
    for (std::size_t i = 0; i < links.size(); ++i) {
      sample.segments[i].position = links[i].position;
      sample.segments[i].orientation =
          links[i].orientation * urdf::SegmentFromLink(static_cast<int>(i)).conjugate();
      // A file may give either sign of a quaternion, and changes it between frames.
      if (frame % 2 == 1) sample.segments[i].orientation.coeffs() *= -1;
      sample.segments[i].velocity = {0.1 * frame, 0, 1};
      sample.segments[i].angular_velocity = {0, 0.2 * frame, 2};
    }
    sample.has_linear = sample.has_angular = true;
    sample.com = CenterOfMass{{0, 0, 0.9}, {0.1, 0, 0}, {0, 0.2, 0}, frame % 2 == 0};
    if (!sample.com->has_derivatives)
      sample.com->velocity = sample.com->acceleration = Vector3d::Zero();
    sample.streamed_angles_deg.emplace();
    for (std::size_t j = 0; j < urdf::kJointCount; ++j) {
      (*sample.streamed_angles_deg)[j] = {static_cast<double>(j), 0.5 * frame, -1};
    }
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace kinescope::mvn::testing
