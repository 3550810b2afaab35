#include "server/scene/scene_builder.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/system/check.h"
#include "core/system/clocks.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;

// A person who sent nothing for this long while others do has left.
constexpr std::int64_t kGoneAfterNanos = 1'000'000'000;

JointLoad Unknown(int joint, const Vector3d& position, std::string_view reason) {
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  JointLoad load;
  load.joint = joint;
  load.position = position;
  load.moment = load.force = Vector3d::Constant(kNothing);
  load.ratio = load.shown_ratio = load.deciding_moment = load.capacity = kNothing;
  load.reason = reason;
  return load;
}

}  // namespace

SceneBuilder::SceneBuilder(SceneOptions options, std::string source, double nominal_rate_hz,
                           OnState on_state)
    : options_(std::move(options)),
      models_(options_),
      source_(std::move(source)),
      on_state_(std::move(on_state)),
      rate_(nominal_rate_hz) {
  SetLoads(options_.loads);
  if (options_.wrenches) recorded_forces_.emplace(*options_.wrenches, nominal_rate_hz);
}

void SceneBuilder::SetLoads(const loads::LoadSettings& settings) {
  KINESCOPE_CHECK(loads::FindDefect(settings).empty());
  options_.loads = settings;
  options_.loads.strength.sex = options_.body.sex;
  current_.class_limits = settings.meter.up;
}

void SceneBuilder::SetMeasurements(int character, const loads::Measurements& measured) {
  PersonInputs& inputs = inputs_[character];
  inputs.measured = measured;
  ForgetStoppedHands(inputs);
}

void SceneBuilder::SetHandLoad(int character, const HandLoad& load) {
  KINESCOPE_CHECK(loads::FindDefect(load).empty());
  PersonInputs& inputs = inputs_[character];
  inputs.hand_load = load;
  inputs.hand_load_nanos = current_.stamp_nanos;
  ForgetStoppedHands(inputs);
}

// A sensor that has stopped leaves a hand's load unknown until the load is set.
void SceneBuilder::ForgetStoppedHands(PersonInputs& inputs) {
  if (!inputs.hand_load) return;
  for (auto& hand : inputs.measured.hands) {
    const bool came_before = hand && hand->stamp_nanos < inputs.hand_load_nanos;
    if (came_before && !loads::IsFresh(hand->stamp_nanos, inputs.hand_load_nanos)) hand.reset();
  }
}

void SceneBuilder::Start() { Publish(Liveness::kNoData); }

void SceneBuilder::OnCharacter(const Character& character) {
  if (!character.skeleton && !character.scaled_segments.empty()) {
    clusters_[character.id] = character;
    return;
  }
  const auto [person, is_new] =
      people_.try_emplace(character.id, models_, character, people_.size());
  if (!is_new) person->second.SetCharacter(character);
}

PersonTracker& SceneBuilder::TrackerOf(const BodySample& sample) {
  const auto known = people_.find(sample.character);
  if (known != people_.end()) return known->second;
  Character character;
  character.id = sample.character;
  return people_.try_emplace(sample.character, models_, character, people_.size()).first->second;
}

void SceneBuilder::OnSample(const BodySample& sample, const loads::BodyMotion* motion) {
  const auto inputs = inputs_.find(sample.character);
  static const PersonInputs kNoInputs;
  const PersonInputs& given = inputs == inputs_.end() ? kNoInputs : inputs->second;
  loads::LoadSettings settings = options_.loads;
  if (given.hand_load) settings.hands = *given.hand_load;
  const bool has_forces = recorded_forces_ && recorded_forces_->AreOf(sample);
  TrackerOf(sample).Update(sample, settings, given.measured,
                           {options_.floor_z, motion, has_forces ? &*recorded_forces_ : nullptr});
  rate_.Add(sample);
  current_.rate_hz = rate_.hz();
  current_.stamp_nanos = sample.stamp_nanos;
  current_.counter = sample.counter;
  current_.time_code_millis = sample.time_code_millis;
  current_.arrival_nanos = sample.arrival_nanos;
  const auto first = std::find_if(people_.begin(), people_.end(),
                                  [](const auto& entry) { return entry.second.floor_z(); });
  current_.floor_z = *first->second.floor_z();
  Publish(Liveness::kLive);
}

// Objects alone are no motion to show: they wait for the next sample of a person.
void SceneBuilder::OnObjects(const ObjectsSample& sample) {
  const Character& cluster = clusters_[sample.character];
  std::vector<TrackedObject>& objects = objects_[sample.character];
  objects.clear();
  for (std::size_t i = 0; i < sample.poses.size(); ++i) {
    if (!sample.present.test(i)) continue;
    const bool has_name =
        i < cluster.scaled_segments.size() && !cluster.scaled_segments[i].name.empty();
    objects.push_back(
        {sample.character, static_cast<int>(i),
         has_name ? cluster.scaled_segments[i].name : "object_" + std::to_string(i + 1),
         sample.poses[i], sample.stamp_nanos});
  }
}

void SceneBuilder::Publish(Liveness liveness) {
  current_.liveness = liveness;
  current_.number += 1;
  current_.source = source_;
  const auto scene = std::make_shared<SceneState>(current_);
  for (const auto& [id, person] : people_) {
    const PersonState* const state = person.state();
    if (state == nullptr) continue;
    if (current_.stamp_nanos - state->sample.stamp_nanos > kGoneAfterNanos) continue;
    scene->people.push_back(*state);
    if (liveness == Liveness::kLive) continue;
    constexpr std::string_view kStopped = "the stream stopped";  // old loads must not look valid
    for (JointLoad& load : scene->people.back().loads) {
      const std::array<double, 4> band_secs = load.band_secs;
      load = Unknown(load.joint, load.position, kStopped);
      load.band_secs = band_secs;
    }
    MakeUnknown(kStopped, scene->people.back().forces);
  }
  for (const auto& [id, cluster] : objects_) {
    for (const TrackedObject& object : cluster) {
      if (current_.stamp_nanos - object.stamp_nanos > kGoneAfterNanos) continue;
      scene->objects.push_back(object);
    }
  }
  on_state_(scene);
}

void SceneBuilder::SetMarkers(std::vector<std::shared_ptr<const SceneMarker>> markers) {
  current_.markers = std::move(markers);
  if (current_.liveness != Liveness::kLive) Publish(current_.liveness);
}

void SceneBuilder::Tick(std::int64_t monotonic_nanos) {
  if (current_.liveness != Liveness::kLive || current_.arrival_nanos == 0) return;
  const double silent_secs = Secs(monotonic_nanos - current_.arrival_nanos);
  if (silent_secs >= options_.stale_secs) MarkStale();
}

void SceneBuilder::MarkStale() {
  rate_.Stop();
  current_.rate_hz = 0;
  Publish(Liveness::kStale);
}

}  // namespace kinescope::app
