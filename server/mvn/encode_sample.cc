// Encodes samples and characters as the messages that a current MVN sends.
#include <algorithm>
#include <utility>

#include "core/system/check.h"
#include "core/system/clocks.h"
#include "server/mvn/encode.h"
#include "server/mvn/item_reader.h"

namespace kinescope::mvn {
namespace {

constexpr double kGravity = 9.81;  // m/s^2, as in MVN
constexpr std::int64_t kMillisPerDay = 86'400'000;

// The segments with sensors in a full suit (mvn-protocol.md, type 23).
constexpr std::array<urdf::Segment, 17> kTrackedSegments = {
    urdf::kPelvis,        urdf::kT8,           urdf::kHead,         urdf::kRightShoulder,
    urdf::kRightUpperArm, urdf::kRightForeArm, urdf::kRightHand,    urdf::kLeftShoulder,
    urdf::kLeftUpperArm,  urdf::kLeftForeArm,  urdf::kLeftHand,     urdf::kRightUpperLeg,
    urdf::kRightLowerLeg, urdf::kRightFoot,    urdf::kLeftUpperLeg, urdf::kLeftLowerLeg,
    urdf::kLeftFoot};

// The earth's magnetic field for generated trackers: unit length, north along x, inclined as in
// central Europe.
const Eigen::Vector3d& MagneticFieldInWorld() {
  constexpr double kDipRadians = 65 * M_PI / 180;
  static const Eigen::Vector3d kField(std::cos(kDipRadians), 0, -std::sin(kDipRadians));
  return kField;
}

struct FingerAndPropCounts {
  int props = 0;
  int finger_segments = 0;
};

// Counts for the header. `is_present` is called for every index of FingerAndPropSegments.
template <class IsPresent>
FingerAndPropCounts CountFingersAndProps(const IsPresent& is_present) {
  FingerAndPropCounts counts;
  for (int prop = 0; prop < kMaxProps; ++prop) {
    if (is_present(static_cast<std::size_t>(PropIndex(prop)))) counts.props = prop + 1;
  }
  for (std::size_t index = kMaxProps; index < kFingerAndPropCount; ++index) {
    if (is_present(index)) counts.finger_segments = 2 * kFingersPerHand;
  }
  return counts;
}

// Writes the datagrams of one sample, or of one character, with a common header.
class Writer {
 public:
  Writer(int character, int body_segments, const FingerAndPropCounts& counts) {
    header_.character = character;
    header_.body_segments = body_segments;
    header_.props = counts.props;
    header_.finger_segments = counts.finger_segments;
  }

  void SetTime(std::uint32_t counter, std::int64_t time_code_millis) {
    header_.sample_counter = counter;
    header_.time_code_millis = static_cast<std::uint32_t>(time_code_millis);
  }

  void Add(Body body) { AddPart(std::move(body), 0, true); }
  void AddPart(Body body, int part, bool is_last) {
    Message message{header_, std::move(body)};
    message.header.part = part;
    message.header.is_last_part = is_last;
    datagrams_.push_back(Encode(message));
  }

  std::vector<std::string> Take() { return std::move(datagrams_); }

 private:
  Header header_;
  std::vector<std::string> datagrams_;
};

// A body's 23 segments; `item_of` makes the item of one.
template <class Message, class ItemOf>
Message ForAllSegments(const BodySample& sample, const ItemOf& item_of) {
  Message body;
  for (std::size_t i = 0; i < sample.segments.size(); ++i) {
    body.items[i] = item_of(sample.segments[i]);
    body.present.set(i);
  }
  return body;
}

template <class PoseBody>
PoseBody Poses(const BodySample& sample) {
  auto body = ForAllSegments<PoseBody>(sample, [](const SegmentState& segment) {
    return PoseItem{segment.position, segment.orientation};
  });
  for (std::size_t i = 0; i < sample.fingers_and_props.poses.size(); ++i) {
    if (!sample.fingers_and_props.present.test(i)) continue;
    const std::size_t slot = urdf::kSegmentCount + i;
    body.items[slot] = {sample.fingers_and_props.poses[i].position,
                        sample.fingers_and_props.poses[i].orientation};
    body.present.set(slot);
  }
  return body;
}

template <class PoseBody>
PoseBody Poses(const ObjectsSample& sample) {
  PoseBody body;
  for (std::size_t i = 0; i < sample.poses.size(); ++i) {
    if (!sample.present.test(i)) continue;
    body.items[i] = {sample.poses[i].position, sample.poses[i].orientation};
    body.present.set(i);
  }
  return body;
}

MarkersMessage Markers(const BodySample& sample, const urdf::Landmarks& landmarks) {
  MarkersMessage body;
  for (const urdf::Landmark& landmark : landmarks) {
    if (static_cast<std::size_t>(body.count) == body.markers.size()) break;
    const SegmentState& carrier = sample.segments[urdf::At(landmark.segment)];
    body.markers[static_cast<std::size_t>(body.count++)] = {
        static_cast<std::uint32_t>(landmark.segment + 1),
        static_cast<std::uint32_t>(landmark.number),
        carrier.position + carrier.orientation * landmark.in_segment};
  }
  return body;
}

LinearMessage Linear(const BodySample& sample) {
  return ForAllSegments<LinearMessage>(sample, [](const SegmentState& segment) {
    return LinearItem{segment.position, segment.velocity, segment.acceleration};
  });
}

AngularMessage Angular(const BodySample& sample) {
  return ForAllSegments<AngularMessage>(sample, [](const SegmentState& segment) {
    return AngularItem{segment.orientation, segment.angular_velocity, segment.angular_acceleration};
  });
}

// The measurements of a sensor at the origin of `segment` with its orientation.
TrackerState TrackerOn(const SegmentState& segment) {
  const Eigen::Quaterniond sensor_from_world = segment.orientation.conjugate();
  TrackerState tracker;
  tracker.orientation = segment.orientation;
  tracker.free_acceleration = segment.acceleration;
  // An accelerometer measures the supporting force: + g at rest.
  tracker.acceleration =
      sensor_from_world * (segment.acceleration + kGravity * Eigen::Vector3d::UnitZ());
  tracker.angular_velocity = sensor_from_world * segment.angular_velocity;
  tracker.magnetic_field = sensor_from_world * MagneticFieldInWorld();
  tracker.has_rates = true;
  return tracker;
}

TrackersMessage Trackers(const BodySample& sample) {
  TrackersMessage body;
  if (sample.has_tracker.any()) {
    body.trackers = sample.trackers;
    body.present = sample.has_tracker;
    return body;
  }
  for (const urdf::Segment segment : kTrackedSegments) {
    body.trackers[urdf::At(segment)] = TrackerOn(sample.segments[urdf::At(segment)]);
    body.present.set(urdf::At(segment));
  }
  return body;
}

bool HasTrackers(const BodySample& sample) {
  return sample.has_tracker.any() || (sample.has_linear && sample.has_angular);
}

TimeCodeMessage TimeOfDay(const BodySample& sample) {
  if (sample.utc_millis_of_day) return {*sample.utc_millis_of_day};
  const std::int64_t millis = sample.stamp_nanos / kNanosPerMilli % kMillisPerDay;
  return {static_cast<std::int32_t>(millis < 0 ? millis + kMillisPerDay : millis)};
}

std::string Cleaned(const std::string& name) { return CleanText(name, kLongestName); }

// The segments of type 13: a person's body, then props, left hand, right hand.
ScaleMessage ScaleSegments(const Character& character) {
  ScaleMessage body;
  if (character.skeleton) {
    const auto origins = TPoseOrigins(*character.skeleton);
    for (std::size_t i = 0; i < origins.size(); ++i) {
      body.segments.push_back({std::string(urdf::kSegments[i].mvn_name), origins[i]});
    }
  }
  for (const ScaledSegment& segment : character.scaled_segments) {
    if (character.skeleton && segment.name.empty()) continue;  // a place without a segment
    body.segments.push_back({Cleaned(segment.name), segment.origin_in_world});
  }
  return body;
}

void AddLandmarks(const urdf::Landmarks& landmarks, Writer& out) {
  constexpr std::size_t kPerPart = 32;  // as a current MVN sends them
  ScaleMessage body;
  int part = 1;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const urdf::Landmark& landmark = landmarks[i];
    body.points.push_back({landmark.segment + 1, landmark.number, Cleaned(landmark.name),
                           landmark.flags, landmark.in_segment});
    const bool is_last = i + 1 == landmarks.size();
    if (body.points.size() < kPerPart && !is_last) continue;
    out.AddPart(std::exchange(body, {}), part++, is_last);
  }
}

}  // namespace

urdf::Landmarks LandmarksToSend(const Character& character) {
  if (!character.landmarks.empty() || !character.skeleton) return character.landmarks;
  return urdf::JointLandmarksOf(*character.skeleton);
}

const TypeSet& UsualTypes() {
  static const TypeSet kTypes = MakeTypeSet(
      {Type::kPose, Type::kJointAngles, Type::kLinear, Type::kAngular, Type::kCenterOfMass});
  return kTypes;
}

std::vector<std::string> EncodeSample(const BodySample& sample, const TypeSet& types,
                                      const urdf::Landmarks& landmarks) {
  const FingerAndPropCounts counts = CountFingersAndProps(
      [&](std::size_t index) { return sample.fingers_and_props.present.test(index); });
  Writer out(sample.character, urdf::kSegmentCount, counts);
  out.SetTime(sample.counter, sample.time_code_millis);
  const auto add = [&](Type type, bool has_it, const auto& make) {
    if (has_it && Contains(types, type)) out.Add(make());
  };
  add(Type::kEulerPose, true, [&] { return Poses<EulerPoseMessage>(sample); });
  add(Type::kPose, true, [&] { return Poses<PoseMessage>(sample); });
  add(Type::kMarkers, !landmarks.empty(), [&] { return Markers(sample, landmarks); });
  add(Type::kJointAngles, sample.streamed_angles_deg.has_value(), [&] {
    JointAnglesMessage body;
    body.joints = *sample.streamed_angles_deg;
    body.joints_present.set();
    return body;
  });
  add(Type::kLinear, sample.has_linear, [&] { return Linear(sample); });
  add(Type::kAngular, sample.has_angular, [&] { return Angular(sample); });
  add(Type::kTrackers, HasTrackers(sample), [&] { return Trackers(sample); });
  add(Type::kCenterOfMass, sample.com.has_value(), [&] {
    return CenterOfMassMessage{sample.com->position, sample.com->velocity, sample.com->acceleration,
                               sample.com->has_derivatives};
  });
  add(Type::kTimeCode, true, [&] { return TimeOfDay(sample); });
  return out.Take();
}

std::vector<std::string> EncodeObjects(const ObjectsSample& sample, const TypeSet& types) {
  int count = 0;
  for (std::size_t i = 0; i < sample.present.size(); ++i) {
    if (sample.present.test(i)) count = static_cast<int>(i) + 1;
  }
  Writer out(sample.character, count, {});
  out.SetTime(sample.counter, sample.time_code_millis);
  if (Contains(types, Type::kEulerPose)) out.Add(Poses<EulerPoseMessage>(sample));
  if (Contains(types, Type::kPose)) out.Add(Poses<PoseMessage>(sample));
  return out.Take();
}

std::vector<std::string> EncodeCharacter(const Character& character) {
  const bool is_objects = !character.skeleton && !character.scaled_segments.empty() &&
                          character.scaled_segments.size() <= urdf::kSegmentCount;
  const FingerAndPropCounts counts = CountFingersAndProps([&](std::size_t index) {
    return !is_objects && index < character.scaled_segments.size() &&
           !character.scaled_segments[index].name.empty();
  });
  Writer out(character.id,
             is_objects ? static_cast<int>(character.scaled_segments.size()) : urdf::kSegmentCount,
             counts);
  MetaDataMessage meta;
  if (!character.name.empty()) meta.name = Cleaned(character.name);
  meta.color_rgb = character.color_rgb;
  out.Add(meta);
  if (is_objects) {
    out.Add(ScaleSegments(character));
  } else if (character.skeleton) {
    out.AddPart(ScaleSegments(character), 0, false);
    AddLandmarks(LandmarksToSend(character), out);
  }
  return out.Take();
}

std::array<Eigen::Vector3d, urdf::kSegmentCount> TPoseOrigins(const urdf::Skeleton& skeleton) {
  std::array<Eigen::Vector3d, urdf::kSegmentCount> origins;
  origins[urdf::kPelvis] =
      urdf::NPoseOrigins(skeleton)[urdf::kPelvis];  // the legs are as in the N-pose
  for (int segment = 1; segment < urdf::kSegmentCount; ++segment) {
    const int parent = urdf::kSegments[urdf::At(segment)].parent;
    origins[urdf::At(segment)] =
        origins[urdf::At(parent)] +
        urdf::SegmentFromLink(parent) * skeleton.origin_in_parent[urdf::At(segment)];
  }
  return origins;
}

}  // namespace kinescope::mvn
