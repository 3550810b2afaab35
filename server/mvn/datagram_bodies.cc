// Parses the bodies that are not just rows of numbers per segment.
#include <algorithm>
#include <charconv>

#include "server/mvn/item_reader.h"

namespace kinescope::mvn {
namespace {

constexpr std::size_t kJointItemBytes = 20;

std::uint32_t PointId(int segment, std::uint32_t point) {
  return (static_cast<std::uint32_t>(segment) + 1U) * 256U + point;
}

// Finds the joint of an item. Pelvis_T8 and Vertical_T8 have the same pair of ids: the second one
// is Vertical_T8.
class JointFinder {
 public:
  explicit JointFinder(JointAnglesMessage& out) : out_(out) {}

  enum class Found { kJoint, kNoJoint, kTwice };

  Found Store(const PointPair& points, const Eigen::Vector3d& angles) {
    // The child of joint j is segment j + 1, at its own first point.
    const std::uint32_t child_segment = points.child / 256U;
    if (child_segment >= 2 && child_segment <= urdf::kSegmentCount) {
      const auto joint = static_cast<urdf::Joint>(child_segment - 2);
      const PointPair expected = PointsOf(joint);
      if (points.parent == expected.parent && points.child == expected.child) {
        return Set(static_cast<std::size_t>(joint), angles, out_.joints, out_.joints_present);
      }
    }
    bool seen_before = false;
    for (int i = 0; i < kErgonomicJointCount; ++i) {
      const PointPair expected = PointsOf(static_cast<ErgonomicJoint>(i));
      if (points.parent != expected.parent || points.child != expected.child) continue;
      seen_before = out_.ergonomic_present.test(static_cast<std::size_t>(i));
      if (!seen_before) {
        return Set(static_cast<std::size_t>(i), angles, out_.ergonomic, out_.ergonomic_present);
      }
    }
    return seen_before ? Found::kTwice : Found::kNoJoint;
  }

 private:
  template <class Angles, class Present>
  static Found Set(std::size_t index, const Eigen::Vector3d& angles, Angles& all,
                   Present& present) {
    if (present.test(index)) return Found::kTwice;
    present.set(index);
    all[index] = angles;
    return Found::kJoint;
  }

  JointAnglesMessage& out_;
};

void ReadTag(std::string_view tag, std::string_view value, MetaDataMessage& out) {
  if (tag == "name") {
    out.name = CleanText(value, kLongestName);
  } else if (tag == "color" && value.size() == 6) {
    std::uint32_t rgb = 0;
    const char* const end = value.data() + value.size();
    const auto parsed = std::from_chars(value.data(), end, rgb, 16);
    if (parsed.ec == std::errc() && parsed.ptr == end) out.color_rgb = rgb;
  }
}

bool ReadScaleSegment(ItemReader& in, ScaleSegment& segment) {
  std::string_view name;
  if (!in.ReadText(name) || !in.ReadVector(segment.origin_in_world)) return false;
  segment.name = CleanText(name, kLongestName);
  return true;
}

bool ReadScalePoint(ItemReader& in, ScalePoint& point) {
  std::uint16_t segment_id = 0;
  std::uint16_t point_id = 0;
  std::string_view name;
  if (!in.bytes.Read(segment_id) || !in.bytes.Read(point_id)) {
    return in.Fail(Reason::kPayloadSize, 0);
  }
  if (segment_id == 0) return in.Fail(Reason::kIdZero, 0);
  if (!in.ReadText(name)) return false;
  if (!in.bytes.Read(point.flags)) return in.Fail(Reason::kPayloadSize, 0);
  if (!in.ReadVector(point.offset)) return false;
  point.segment_id = segment_id;
  point.point_id = point_id;
  point.name = CleanText(name, kLongestName);
  return true;
}

// "59" of "23:59:01.250", two digits at `at`; -1 if there are none.
int TwoDigits(std::string_view text, std::size_t at) {
  const auto digit = [&](std::size_t i) { return text[i] >= '0' && text[i] <= '9'; };
  if (!digit(at) || !digit(at + 1)) return -1;
  return (text[at] - '0') * 10 + (text[at + 1] - '0');
}

// Up to three digits after the point; 0 without digits or without a point; -1 for anything else.
int Millis(std::string_view fraction) {
  if (fraction.empty()) return 0;
  if (fraction[0] != '.' || fraction.size() > 4) return -1;
  int millis = 0;
  for (std::size_t i = 1; i < 4; ++i) {
    const char c = i < fraction.size() ? fraction[i] : '0';
    if (c < '0' || c > '9') return -1;
    millis = millis * 10 + (c - '0');
  }
  return millis;
}

}  // namespace

bool ParseMarkers(ItemReader& in, const Header& header, MarkersMessage& out) {
  constexpr std::size_t kMarkerBytes = 16;
  ItemLayout layout;
  if (!in.FindLayout(header, kMarkerBytes, layout)) return false;
  for (int i = 0; i < layout.count; ++i) {
    MarkerItem& marker = out.markers[static_cast<std::size_t>(i)];
    std::uint32_t id = 0;
    Eigen::Vector3d centimetres;
    if (!in.GoTo(layout, i) || !in.ReadId(id) || !in.ReadVector(centimetres)) return false;
    if (id < 256) return in.Fail(Reason::kIdZero, id);  // 256 * segment + point
    marker = {id / 256, id % 256, FromYUp(centimetres) * kMetresPerCentimetre};
  }
  out.count = layout.count;
  return true;
}

bool ParseTrackers(ItemReader& in, const Header& header, TrackersMessage& out) {
  constexpr std::size_t kWhole = 68;
  constexpr std::size_t kWithoutRates = 44;  // according to the specification's other section
  ItemLayout layout;
  if (!in.FindLayout(header, kWhole, layout) && !in.FindLayout(header, kWithoutRates, layout)) {
    return false;
  }
  for (int i = 0; i < layout.count; ++i) {
    std::uint32_t id = 0;
    TrackerState tracker;
    tracker.has_rates = layout.stride >= kWhole;
    if (!in.GoTo(layout, i) || !in.ReadId(id) || !in.ReadUnitQuaternion(tracker.orientation) ||
        !in.ReadVector(tracker.free_acceleration) ||
        (tracker.has_rates &&
         !(in.ReadVector(tracker.acceleration) && in.ReadVector(tracker.angular_velocity))) ||
        !in.ReadVector(tracker.magnetic_field)) {
      return false;
    }
    if (id > urdf::kSegmentCount) {
      ++out.skipped;
      continue;
    }
    const std::size_t segment = id - 1;
    if (out.present.test(segment)) return in.Fail(Reason::kRepeatedId, id);
    out.present.set(segment);
    out.trackers[segment] = tracker;
  }
  return true;
}

bool ParseTimeCode(ItemReader& in, TimeCodeMessage& out) {
  constexpr std::size_t kShortest = 8;  // "HH:MM:SS"
  constexpr std::size_t kLengthBytes = 4;
  std::string_view text = in.bytes.ReadRest();
  // The specification has no length before the text, but senders send one. One sender counts it
  // wrong, so the length is only an upper limit.
  std::uint32_t length = 0;
  if (text.size() > kLengthBytes && (text[0] < '0' || text[0] > '9') &&
      ByteReader(text).Read(length)) {
    text = text.substr(kLengthBytes, length);
  }
  if (text.size() < kShortest) {
    return in.Fail(Reason::kPayloadSize, static_cast<std::int64_t>(text.size()));
  }
  const int hours = TwoDigits(text, 0), minutes = TwoDigits(text, 3);
  const int seconds = TwoDigits(text, 6), millis = Millis(text.substr(kShortest));
  const bool is_time = text[2] == ':' && text[5] == ':' && hours >= 0 && hours < 24 &&
                       minutes >= 0 && minutes < 60 && seconds >= 0 && seconds <= 60 && millis >= 0;
  if (!is_time) return in.Fail(Reason::kTimeOfDay, 0);
  const bool leap = seconds == 60;
  out.utc_millis_of_day =
      ((hours * 60 + minutes) * 60 + (leap ? 59 : seconds)) * 1000 + (leap ? 999 : millis);
  return true;
}

PointPair PointsOf(urdf::Joint joint) {
  const auto point = static_cast<std::uint32_t>(urdf::PointNumberInParent(joint));
  return {PointId(urdf::ParentOf(joint), point), PointId(urdf::ChildOf(joint), 1)};
}

PointPair PointsOf(ErgonomicJoint joint) {
  switch (joint) {
    case kT8Head: return {PointId(urdf::kT8, 0), PointId(urdf::kHead, 0)};
    case kT8LeftUpperArm: return {PointId(urdf::kT8, 0), PointId(urdf::kLeftUpperArm, 0)};
    case kT8RightUpperArm: return {PointId(urdf::kT8, 0), PointId(urdf::kRightUpperArm, 0)};
    case kVerticalPelvis: return {PointId(urdf::kPelvis, 0), PointId(urdf::kPelvis, 0)};
    case kPelvisT8:
    case kVerticalT8: break;
  }
  return {PointId(urdf::kPelvis, 0), PointId(urdf::kT8, 0)};
}

bool ParseJointAngles(ItemReader& in, const Header& header, JointAnglesMessage& out) {
  ItemLayout layout;
  if (!in.FindLayout(header, kJointItemBytes, layout)) return false;
  JointFinder finder(out);
  for (int i = 0; i < layout.count; ++i) {
    PointPair points;
    Eigen::Vector3d angles;
    if (!in.GoTo(layout, i) || !in.ReadId(points.parent) || !in.ReadId(points.child) ||
        !in.ReadVector(angles)) {
      return false;
    }
    if (points.parent < 256 || points.child < 256) return in.Fail(Reason::kIdZero, 0);
    switch (finder.Store(points, angles)) {
      case JointFinder::Found::kTwice: return in.Fail(Reason::kRepeatedId, points.child);
      case JointFinder::Found::kNoJoint: ++out.skipped; break;
      case JointFinder::Found::kJoint: break;
    }
  }
  return true;
}

bool ParseMetaData(ItemReader& in, MetaDataMessage& out) {
  std::string_view text;
  if (!in.ReadText(text)) return false;
  while (!text.empty()) {
    const std::size_t line_end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, line_end);
    text.remove_prefix(std::min(line_end + 1, text.size()));
    // The first colon separates; a name may contain further ones.
    const std::size_t colon = line.find(':');
    if (colon != std::string_view::npos)
      ReadTag(line.substr(0, colon), line.substr(colon + 1), out);
  }
  return true;
}

bool ParseScale(ItemReader& in, ScaleMessage& out) {
  // The shortest possible one: with an empty name.
  constexpr std::size_t kSegmentBytes = 4 + 12;
  constexpr std::size_t kPointBytes = 2 + 2 + 4 + 4 + 12;
  std::uint32_t count = 0;
  if (!in.ReadCount(kSegmentBytes, count)) return false;
  out.segments.resize(count);
  for (ScaleSegment& segment : out.segments) {
    if (!ReadScaleSegment(in, segment)) return false;
  }
  if (!in.ReadCount(kPointBytes, count)) return false;
  out.points.resize(count);
  for (ScalePoint& point : out.points) {
    if (!ReadScalePoint(in, point)) return false;
  }
  return true;
}

}  // namespace kinescope::mvn
