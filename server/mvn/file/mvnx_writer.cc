#include "server/mvn/file/mvnx_writer.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "core/system/clocks.h"
#include "server/mvn/encode.h"
#include "server/mvn/item_reader.h"

namespace kinescope::mvn {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using urdf::At;

// The order of footContactDefinition.
constexpr const char* kWrittenContacts[] = {"LeftFoot_Heel", "LeftFoot_Toe", "RightFoot_Heel",
                                            "RightFoot_Toe"};

// Names of joints and points since MVN 2018.
std::string ModernName(std::string name) {
  const std::size_t at = name.find("C7Shoulder");
  if (at != std::string::npos) name.replace(at, 2, "T4");
  return name;
}

std::string EscapeXml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&': escaped += "&amp;"; break;
      case '<': escaped += "&lt;"; break;
      case '>': escaped += "&gt;"; break;
      case '"': escaped += "&quot;"; break;
      default: escaped += c;
    }
  }
  return escaped;
}

std::string Attribute(std::string_view text) {
  return EscapeXml(CleanText(std::string(text), kLongestName));
}

void Number(double value, std::string& out) {
  if (!out.empty() && out.back() != '>') out += ' ';
  fmt::format_to(std::back_inserter(out), "{}", value);
}
void Numbers(const Vector3d& value, std::string& out) {
  for (const double number : value) Number(number, out);
}
void Numbers(const Quaterniond& value, std::string& out) {
  for (const double number : {value.w(), value.x(), value.y(), value.z()}) Number(number, out);
}

// One element of a frame on a line of its own; `write` appends its numbers.
template <class Write>
void List(const char* name, const Write& write, std::string& out) {
  out += "\t\t\t\t<";
  out += name;
  out += '>';
  write();
  out += "</";
  out += name;
  out += ">\n";
}

template <class Values>
void ListOf(const char* name, const Values& values, std::string& out) {
  List(
      name,
      [&] {
        for (const auto& value : values) Numbers(value, out);
      },
      out);
}

void ListOfSegments(const char* name, const BodySample& sample, Vector3d SegmentState::*member,
                    std::string& out) {
  List(
      name,
      [&] {
        for (const SegmentState& segment : sample.segments) Numbers(segment.*member, out);
      },
      out);
}

// Of every segment: the landmarks that were read, then joints that are missing among them.
urdf::Landmarks PointsOfSegment(const MvnxSubject& subject, int segment) {
  urdf::Landmarks points;
  for (const urdf::Landmark& landmark : subject.landmarks) {
    if (landmark.segment == segment) points.push_back(landmark);
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const auto& a, const auto& b) { return a.number < b.number; });
  for (urdf::Landmark& joint : urdf::JointLandmarksOf(subject.skeleton)) {
    const bool is_there = std::any_of(points.begin(), points.end(), [&](const auto& point) {
      return ModernName(point.name) == ModernName(joint.name);
    });
    if (joint.segment == segment && !is_there) points.push_back(std::move(joint));
  }
  return points;
}

std::string PointRef(int segment, const std::string& point) {
  return fmt::format("{}/{}", urdf::kSegments[At(segment)].mvn_name, point);
}

}  // namespace

void MvnxWriter::AppendSegments(std::string& out) const {
  out += "\t\t<segments>\n";
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    out += fmt::format("\t\t\t<segment label=\"{}\" id=\"{}\">\n\t\t\t\t<points>\n",
                       urdf::kSegments[At(segment)].mvn_name, segment + 1);
    for (const urdf::Landmark& point : PointsOfSegment(subject_, segment)) {
      out += fmt::format("\t\t\t\t\t<point label=\"{}\">\n\t\t\t\t\t\t<pos_b>",
                         Attribute(ModernName(point.name)));
      Numbers(point.in_segment, out);
      out += "</pos_b>\n\t\t\t\t\t</point>\n";
    }
    out += "\t\t\t\t</points>\n\t\t\t</segment>\n";
  }
  out += "\t\t</segments>\n";
}

void MvnxWriter::AppendDefinitions(std::string& out) const {
  if (subject_.sensors.any()) {
    out += "\t\t<sensors>\n";
    for (std::size_t i = 0; i < urdf::kSegmentCount; ++i) {
      if (!subject_.sensors.test(i)) continue;
      out += fmt::format("\t\t\t<sensor label=\"{}\"/>\n", urdf::kSegments[i].mvn_name);
    }
    out += "\t\t</sensors>\n";
  }
  out += "\t\t<joints>\n";
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    const std::string name = ModernName(std::string(urdf::kJoints[At(joint)].mvn_name));
    out += fmt::format(
        "\t\t\t<joint label=\"{}\">\n\t\t\t\t<connector1>{}</connector1>\n"
        "\t\t\t\t<connector2>{}</connector2>\n\t\t\t</joint>\n",
        name, PointRef(urdf::ParentOf(joint), name), PointRef(urdf::ChildOf(joint), name));
  }
  out += "\t\t</joints>\n\t\t<ergonomicJointAngles>\n";
  for (std::size_t i = 0; i < urdf::kErgonomicAngleCount; ++i) {
    const urdf::ErgonomicAngleInfo& angle = urdf::kErgonomicAngles[i];
    out += fmt::format(
        "\t\t\t<ergonomicJointAngle label=\"{}\" index=\"{}\" parentSegment=\"{}\" "
        "childSegment=\"{}\"/>\n",
        angle.name, i, angle.parent, urdf::kSegments[At(angle.child)].mvn_name);
  }
  out += "\t\t</ergonomicJointAngles>\n";
  if (!subject_.has_foot_contacts) return;
  out += "\t\t<footContactDefinition>\n";
  for (std::size_t i = 0; i < std::size(kWrittenContacts); ++i) {
    out += fmt::format("\t\t\t<contactDefinition label=\"{}\" index=\"{}\"/>\n",
                       kWrittenContacts[i], i);
  }
  out += "\t\t</footContactDefinition>\n";
}

void MvnxWriter::AppendCalibration(const char* type, bool is_isb, std::string& out) const {
  out += fmt::format("\t\t\t<frame time=\"0\" tc=\"00:00:00:00\" ms=\"0\" type=\"{}\">\n", type);
  urdf::SegmentOrientations orientations;
  for (int i = 0; i < urdf::kSegmentCount; ++i) {
    orientations[At(i)] = is_isb ? urdf::SegmentFromIsb(i) : Quaterniond::Identity();
  }
  ListOf("orientation", orientations, out);
  auto origins = TPoseOrigins(subject_.skeleton);
  constexpr double kPerMetre = 1e6;  // as many digits as MVN writes
  for (Vector3d& origin : origins) {
    origin = (kPerMetre * origin).array().round().matrix() / kPerMetre;
  }
  ListOf("position", origins, out);
  out += "\t\t\t</frame>\n";
}

void MvnxWriter::AppendHead(std::string& out) const {
  out += fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<mvnx xmlns=\"http://www.xsens.com/mvn/mvnx\" version=\"4\">\n"
      "\t<mvn version=\"{}\" build=\"\"/>\n\t<comment>{}</comment>\n",
      Attribute(subject_.program), EscapeXml(subject_.comment));
  out += fmt::format("\t<subject label=\"{}\"", Attribute(subject_.label));
  if (subject_.color_rgb) out += fmt::format(" torsoColor=\"#{:06x}\"", *subject_.color_rgb);
  out +=
      fmt::format(" frameRate=\"{}\" segmentCount=\"{}\"", subject_.rate_hz, urdf::kSegmentCount);
  if (subject_.began_nanos) {
    const std::int64_t millis = *subject_.began_nanos / kNanosPerMilli;
    out += fmt::format(" recDate=\"{:%a %b %d %H:%M:%S}.{:03} {:%Y}\"",
                       fmt::gmtime(static_cast<std::time_t>(millis / 1000)), millis % 1000,
                       fmt::gmtime(static_cast<std::time_t>(millis / 1000)));
    out += fmt::format(" recDateMSecsSinceEpoch=\"{}\"", millis);
  }
  out += fmt::format(" originalFilename=\"{}\">\n\t\t<comment></comment>\n",
                     Attribute(subject_.original_file));
  AppendSegments(out);
  AppendDefinitions(out);
  out += fmt::format("\t\t<frames segmentCount=\"{}\" sensorCount=\"{}\" jointCount=\"{}\">\n",
                     urdf::kSegmentCount, subject_.sensors.count(), urdf::kJointCount);
  AppendCalibration("identity", false, out);
  AppendCalibration("tpose", false, out);
  AppendCalibration("tpose-isb", true, out);
}

void MvnxWriter::AppendTimes(const BodySample& sample, std::int64_t index, std::string& out) const {
  const auto millis = static_cast<std::int64_t>(
      std::llround(1000.0 * static_cast<double>(index) / subject_.rate_hz));
  out += fmt::format("\t\t\t<frame time=\"{}\" index=\"{}\"", millis, index);
  if (sample.has_time_of_day) {
    // Nearest, so that reading the file back does not shift it.
    const std::int64_t unix_millis = (sample.stamp_nanos + kNanosPerMilli / 2) / kNanosPerMilli;
    const auto frame = static_cast<int>(
        std::floor(static_cast<double>(unix_millis % 1000) * subject_.rate_hz / 1000.0));
    out += fmt::format(" tc=\"{:%H:%M:%S}:{:0{}}\" ms=\"{}\"",
                       fmt::gmtime(static_cast<std::time_t>(unix_millis / 1000)), frame,
                       subject_.rate_hz > 100 ? 3 : 2, unix_millis);
  }
  out += " type=\"normal\">\n";
}

void MvnxWriter::AppendTrackers(const BodySample& sample, std::string& out) const {
  const auto list = [&](const char* name, const auto& value_of) {
    List(
        name,
        [&] {
          for (std::size_t i = 0; i < urdf::kSegmentCount; ++i) {
            if (subject_.sensors.test(i)) Numbers(value_of(sample.trackers[i]), out);
          }
        },
        out);
  };
  list("sensorFreeAcceleration", [](const TrackerState& t) { return t.free_acceleration; });
  list("sensorMagneticField", [](const TrackerState& t) { return t.magnetic_field; });
  list("sensorOrientation", [](const TrackerState& t) { return t.orientation; });
}

void MvnxWriter::AppendFrame(const BodySample& sample, std::int64_t index, std::string& out) {
  using urdf::AngleSequence;
  urdf::SegmentOrientations orientations = OrientationsOf(sample);
  for (std::size_t i = 0; i < orientations.size(); ++i) {
    const bool flips =
        previous_ ? orientations[i].dot((*previous_)[i]) < 0 : orientations[i].w() < 0;
    if (flips) orientations[i].coeffs() = -orientations[i].coeffs();
  }
  previous_ = orientations;
  AppendTimes(sample, index, out);
  ListOf("orientation", orientations, out);
  ListOfSegments("position", sample, &SegmentState::position, out);
  if (sample.has_linear) {
    ListOfSegments("velocity", sample, &SegmentState::velocity, out);
    ListOfSegments("acceleration", sample, &SegmentState::acceleration, out);
  }
  if (sample.has_angular) {
    ListOfSegments("angularVelocity", sample, &SegmentState::angular_velocity, out);
    ListOfSegments("angularAcceleration", sample, &SegmentState::angular_acceleration, out);
  }
  if (subject_.has_foot_contacts && sample.foot_contacts) {
    const auto& feet = *sample.foot_contacts;
    out += fmt::format("\t\t\t\t<footContacts>{:d} {:d} {:d} {:d}</footContacts>\n",
                       feet[urdf::kLeft].heel, feet[urdf::kLeft].forefoot, feet[urdf::kRight].heel,
                       feet[urdf::kRight].forefoot);
  }
  const bool has_trackers =
      subject_.sensors.any() && (sample.has_tracker & subject_.sensors) == subject_.sensors;
  if (has_trackers) AppendTrackers(sample, out);
  ListOf("jointAngle",
         sample.streamed_angles_deg.value_or(
             urdf::AnatomicalAngles(orientations, AngleSequence::kZxy)),
         out);
  ListOf("jointAngleXZY", urdf::AnatomicalAngles(orientations, AngleSequence::kXzy), out);
  ListOf("jointAngleErgo", urdf::ErgonomicAngles(orientations, AngleSequence::kZxy), out);
  ListOf("jointAngleErgoXZY", urdf::ErgonomicAngles(orientations, AngleSequence::kXzy), out);
  if (sample.com) {
    std::vector<Vector3d> values = {sample.com->position};
    if (sample.com->has_derivatives) {
      values.insert(values.end(), {sample.com->velocity, sample.com->acceleration});
    }
    ListOf("centerOfMass", values, out);
  }
  out += "\t\t\t</frame>\n";
}

void MvnxWriter::AppendTail(std::string& out) const {
  // MVN's check sum cannot be computed by others.
  out += "\t\t</frames>\n\t</subject>\n\t<securityCode code=\"\"/>\n</mvnx>\n";
}

}  // namespace kinescope::mvn
