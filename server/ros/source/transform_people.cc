#include "server/ros/source/transform_people.h"

#include "server/ros/raw_message.h"
#include "server/ros/stamp.h"

namespace kinescope::ros_bridge {
namespace {

constexpr char kIncompleteTransforms[] = "sample without all 23 segments";
constexpr char kNoTree[] = "sample whose frames have no common parent";
constexpr char kNaming[] = "message on /tf while frame names are still being collected";
constexpr std::int64_t kMostSettles = 4;
constexpr char kNobody[] = "message on /tf without a person's segment";

urdf::Pose ToPose(const geometry_msgs::Transform& transform) {
  const auto& t = transform.translation;
  const auto& r = transform.rotation;
  return {{t.x, t.y, t.z}, Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized()};
}

}  // namespace

bool TransformPeople::AddName(const std::string& frame) {
  const std::string name = WithoutSlash(frame);
  frames_.Add(name);
  return frames_.IsCandidate(name);
}

void TransformPeople::NoticeNames(const tf2_msgs::TFMessage& message, std::int64_t now) {
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    if (!frames_.Add(WithoutSlash(transform.child_frame_id))) continue;
    if (!new_name_at_) first_new_name_at_ = now;
    new_name_at_ = now;
  }
  if (!new_name_at_) return;
  if (now < *new_name_at_) first_new_name_at_ = new_name_at_ = now;  // the clock was set back
  const bool is_settled = now - *new_name_at_ >= settle_nanos_;
  const bool is_for_long = now - *first_new_name_at_ >= kMostSettles * settle_nanos_;
  if (!is_settled && !is_for_long) return;  // some sender may have new names for good
  new_name_at_.reset();
  frames_.Find();
}

bool TransformPeople::Take(const tf2_msgs::TFMessage& message, const Arrival& arrival,
                           SourceCounters& counters, SampleSink& sink) {
  NoticeNames(message, arrival.stamp_nanos);
  for (std::size_t i = people_.size(); i < frames_.people().size(); ++i) {
    people_.emplace_back(static_cast<int>(i));
    // Static frames are published once, often before the first person appears.
    for (const auto& [name, transform] : static_) AddStatic(transform, counters);
  }
  touched_.clear();
  places_.clear();
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    const PeopleFrames::Place place = frames_.PlaceOf(WithoutSlash(transform.child_frame_id));
    places_.push_back(place);
    if (place.person >= 0) touched_[place.person].set(static_cast<std::size_t>(place.slot));
  }
  for (const auto& [person, slots] : touched_) {
    if (people_[static_cast<std::size_t>(person)].transforms.Begin(slots)) {
      ++counters.rejected[kIncompleteTransforms];
    }
  }
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const PeopleFrames::Place place = places_[i];
    if (place.person < 0) continue;
    auto known = Read(message.transforms[i], place, counters);
    if (!known) continue;
    known->record_nanos = arrival.stamp_nanos;
    if (people_[static_cast<std::size_t>(place.person)].transforms.Add(*known)) {
      ++counters.rejected[kIncompleteTransforms];
    }
  }
  if (touched_.empty()) ++counters.ignored[new_name_at_ ? kNaming : kNobody];
  for (const auto& [person, slots] : touched_) Give(person, arrival, counters, sink);
  return !touched_.empty();
}

void TransformPeople::TakeStatic(const tf2_msgs::TFMessage& message, SourceCounters& counters) {
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    const std::string name = WithoutSlash(transform.child_frame_id);
    const bool is_kept = name.size() <= PeopleFrames::kLongestName &&
                         (static_.size() < kMaxStatic || static_.count(name) > 0);
    if (!is_kept) {
      ++counters.ignored["static frame beyond the limit"];
      continue;
    }
    static_[name] = transform;
    frames_.Add(name);
    AddStatic(transform, counters);
  }
}

void TransformPeople::AddStatic(const geometry_msgs::TransformStamped& transform,
                                SourceCounters& counters) {
  const PeopleFrames::Place place = frames_.PlaceOf(WithoutSlash(transform.child_frame_id));
  const auto index = static_cast<std::size_t>(place.person);
  if (index >= people_.size()) return;
  if (const auto known = Read(transform, place, counters)) {
    people_[index].transforms.AddStatic(*known);
  }
}

void TransformPeople::End(SourceCounters& counters) {
  for (const Person& person : people_) {
    if (person.transforms.End()) ++counters.rejected[kIncompleteTransforms];
  }
}

std::optional<FrameTransform> TransformPeople::Read(
    const geometry_msgs::TransformStamped& transform, const PeopleFrames::Place& place,
    SourceCounters& counters) const {
  const auto& t = transform.transform.translation;
  const auto& r = transform.transform.rotation;
  if (const char* defect = DefectOf({t.x, t.y, t.z}, {r.x, r.y, r.z, r.w})) {
    ++counters.rejected[defect];
    return std::nullopt;
  }
  FrameTransform known;
  known.slot = place.slot;
  known.parent = WithoutSlash(transform.header.frame_id);
  const PeopleFrames::Place parent = frames_.PlaceOf(known.parent);
  known.parent_slot = parent.person == place.person ? parent.slot : -1;
  known.parent_from_child = ToPose(transform.transform);
  known.header_nanos = ToNanos(transform.header.stamp);
  return known;
}

void TransformPeople::Give(int index, const Arrival& arrival, SourceCounters& counters,
                           SampleSink& sink) {
  Person& person = people_[static_cast<std::size_t>(index)];
  const std::uint64_t steps_back = person.transforms.steps_back();
  const TransformPerson::Result result = person.transforms.Finish(arrival.monotonic_nanos, origin_);
  counters.restarts += person.transforms.steps_back() - steps_back;
  switch (result) {
    case TransformPerson::Result::kNothing: return;
    case TransformPerson::Result::kDuplicate: ++counters.duplicates; return;
    case TransformPerson::Result::kNoTree: ++counters.rejected[kNoTree]; return;
    case TransformPerson::Result::kSample: break;
  }
  const BodySample& sample = person.transforms.sample();
  const auto skeleton = person.skeleton.Look(sample);
  if (skeleton || !person.is_known) {
    person.is_known = true;
    Character character;
    character.id = index;
    character.name = frames_.people()[static_cast<std::size_t>(index)].name;
    character.skeleton = skeleton;
    sink.OnCharacter(character);
  }
  ++counters.samples;
  sink.OnSample(sample);
}

}  // namespace kinescope::ros_bridge
