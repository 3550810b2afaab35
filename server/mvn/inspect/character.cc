#include "server/mvn/inspect/character.h"

#include <algorithm>

namespace kinescope::mvn {

void CharacterTally::OnSample(const BodySample& sample) {
  ++people_samples_;
  const auto count = [&](Quantity quantity, bool is_there) {
    if (is_there) ++quantities_[quantity];
  };
  count(kLinear, sample.has_linear);
  count(kAngular, sample.has_angular);
  count(kCom, sample.com.has_value());
  count(kAngles, sample.streamed_angles_deg.has_value());
  count(kTrackers, sample.has_tracker.any());
  count(kUtc, sample.utc_millis_of_day.has_value());
  if (sample.fingers_and_props.present.any()) AddFingersAndProps(sample.fingers_and_props);
}

void CharacterTally::AddFingersAndProps(const FingerAndPropSegments& segments) {
  bool props = false;
  bool gloves = false;
  for (int i = 0; i < kFingerAndPropCount; ++i) {
    if (!segments.present.test(urdf::At(i))) continue;
    (i < kMaxProps ? props : gloves) = true;
  }
  if (props) ++quantities_[kProps];
  if (gloves) ++quantities_[kGloves];
  fingers_and_props_seen_ |= segments.present;
}

void CharacterTally::OnObjects(const ObjectsSample& sample) {
  ++objects_samples_;
  objects_seen_ |= sample.present;
}

void CharacterTally::Fill(CharacterReport& report) const {
  static constexpr std::array<const char*, kQuantities> kNames = {
      "velocity",       "angular velocity", "centre of mass", "joint angles",
      "tracker values", "time of day",      "gloves",         "props"};
  report.samples = people_samples_ + objects_samples_;
  for (std::size_t i = 0; i < quantities_.size(); ++i) {
    if (quantities_[i] > 0) report.quantities[kNames[i]] = quantities_[i];
  }
  if (people_samples_ > 0) report.body_segments = urdf::kSegmentCount;
  report.objects = static_cast<int>(objects_seen_.count());
  for (int i = 0; i < kFingerAndPropCount; ++i) {
    if (!fingers_and_props_seen_.test(urdf::At(i))) continue;
    if (i < kMaxProps) {
      ++report.props;
    } else {
      ++(i < FingerIndex(urdf::kRight, 0) ? report.left_fingers : report.right_fingers);
    }
  }
  const bool has_skeleton = character_ && character_->skeleton;
  if (people_samples_ > objects_samples_ || (people_samples_ == 0 && has_skeleton)) {
    report.kind = CharacterKind::kPerson;
  } else if (objects_samples_ > 0 || (character_ && !character_->scaled_segments.empty())) {
    report.kind = CharacterKind::kObjects;
  }
  if (!character_) return;
  report.name = character_->name;
  report.color_rgb = character_->color_rgb;
  if (has_skeleton) report.height_m = character_->skeleton->height;
  const std::size_t named =
      report.kind == CharacterKind::kPerson
          ? std::min<std::size_t>(kMaxProps, character_->scaled_segments.size())
          : character_->scaled_segments.size();
  for (std::size_t i = 0; i < named; ++i) {
    if (!character_->scaled_segments[i].name.empty())
      report.names.push_back(character_->scaled_segments[i].name);
  }
}

void FillFrames(const FrameTrack& frames, std::int64_t begin_monotonic, CharacterReport& report) {
  report.frames = frames.frames();
  report.first_counter = frames.first_counter();
  report.last_counter = frames.last_counter();
  report.usual_step = frames.usual_step();
  report.smallest_step = frames.smallest_step();
  report.largest_step = frames.largest_step();
  report.lost = frames.lost();
  report.rate_hz = frames.arrival_rate_hz();
  report.capture_rate_hz = frames.capture_rate_hz();
  report.restarts = frames.restarts();
  report.longest_silence_nanos = frames.longest_silence_nanos();
  if (report.longest_silence_nanos > 0) {
    report.longest_silence_at_nanos = frames.longest_silence_began_nanos() - begin_monotonic;
  }
}

}  // namespace kinescope::mvn
