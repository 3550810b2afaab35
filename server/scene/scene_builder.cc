#include "server/scene/scene_builder.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <utility>

#include "core/system/check.h"
#include "core/system/clocks.h"
#include "core/unknown.h"
#include "server/scene/robot_source.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;

// A person who sent nothing for this long while others do has left.
constexpr std::int64_t kGoneAfterNanos = 1'000'000'000;

// By which samples of one source are compared: the stamps of a live one may be of several machines.
template <class Sample>
std::int64_t MomentOf(const Sample& sample) {
  return sample.arrival_nanos != 0 ? sample.arrival_nanos : sample.stamp_nanos;
}

JointLoad Unknown(int joint, const Vector3d& position, std::string_view reason) {
  JointLoad load;
  load.joint = joint;
  load.position = position;
  load.moment = load.force = Vector3d::Constant(kUnknown);
  load.ratio = load.shown_ratio = load.deciding_moment = load.capacity = kUnknown;
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
      view_heading_(options_.view_frame),
      rate_(nominal_rate_hz) {
  SetLoads(options_.loads);
  if (options_.makes_models_aside) maker_ = std::make_unique<ModelMaker>(models_);
  if (options_.wrenches) recorded_forces_.emplace(*options_.wrenches, nominal_rate_hz);
}

void SceneBuilder::SetLoads(const loads::LoadSettings& settings) {
  KINESCOPE_CHECK(loads::FindDefect(settings).empty());
  options_.loads = settings;
  options_.loads.strength.sex = options_.body.sex;
  const loads::LoadMeter::Settings& meter = settings.meter;
  current_.class_limits = meter.up;
  current_.class_falls_below = meter.is_momentary ? meter.up : meter.down;
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

void SceneBuilder::ChangePerson(int character, const PersonChange& change) {
  KINESCOPE_CHECK(FindDefect(change).empty());
  inputs_[character].stated.Add(change);
  const auto person = people_.find(character);
  if (person != people_.end()) person->second.SetStated(StatedOf(character));
}

// An operator's words count more than the options, and these more than those of another node.
PersonChange SceneBuilder::StatedOf(int id) const {
  PersonChange stated;
  const auto character = characters_.find(id);
  if (character != characters_.end()) {
    const PersonChange& told = character->second.told;
    if (options_.body.mass_is_assumed) stated.mass_kg = told.mass_kg;
    PersonChange supposed = stated;
    if (supposed.mass_kg) *supposed.mass_kg *= options_.supposed.mass_factor;
    if (FindDefect(supposed).empty()) stated = supposed;
    if (options_.body.sex_is_assumed) stated.sex = told.sex;
  }
  const auto inputs = inputs_.find(id);
  if (inputs != inputs_.end()) stated.Add(inputs->second.stated);
  return stated;
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

HandLoad SceneBuilder::ToldHandLoadOf(int id) const {
  const auto character = characters_.find(id);
  if (character == characters_.end() || !character->second.told_hand_load.is_known) {
    return options_.supposed.hand_load;
  }
  const HandLoad& told = character->second.told_hand_load;
  HandLoad load = told;
  for (double& kg : load.mass_kg) kg *= options_.supposed.hand_load_factor;
  load.both_kg *= options_.supposed.hand_load_factor;
  return loads::FindDefect(load).empty() ? load : told;
}

// Another node may be wrong, or not be one of ours: what was known stays.
void SceneBuilder::ReplaceImpossible(const Character& before, Character& character) {
  const auto warn = [&](const std::string& defect) {
    constexpr std::size_t kMostSaid = 16;
    if (impossible_once_.size() >= kMostSaid || !impossible_once_.insert(defect).second) return;
    spdlog::warn("what the node of the suit was told about '{}' is not used: {}", character.name,
                 defect);
  };
  if (const std::string defect = FindDefect(character.told); !defect.empty()) {
    warn(defect);
    character.told = before.told;
  }
  if (const std::string defect = loads::FindDefect(character.told_hand_load); !defect.empty()) {
    warn(defect);
    character.told_hand_load = before.told_hand_load;
  }
}

// A description alone makes no person: a sender without poses costs nothing.
void SceneBuilder::OnCharacter(const Character& character) {
  Character& known = characters_[character.id];
  const Character before = std::exchange(known, character);
  ReplaceImpossible(before, known);
  const bool is_of_objects = !character.skeleton && !character.scaled_segments.empty();
  if (is_of_objects) return;
  const auto person = people_.find(character.id);
  if (person == people_.end()) return;
  person->second.SetCharacter(known);
  person->second.SetStated(StatedOf(character.id));
}

PersonTracker& SceneBuilder::TrackerOf(int id) {
  const auto known = people_.find(id);
  if (known != people_.end()) return known->second;
  Character& character = characters_[id];
  character.id = id;
  const auto past = past_.try_emplace(id, PersonTracker::Past{past_.size(), 0, {}}).first;
  PersonTracker& person =
      people_.try_emplace(id, models_, maker_.get(), character, past->second).first->second;
  person.SetStated(StatedOf(id));
  return person;
}

// People come and go; what each of them needs is given back.
void SceneBuilder::ForgetThoseGone() {
  constexpr std::int64_t kForgetAfterNanos = 60 * kNanosPerSecond;
  for (auto person = people_.begin(); person != people_.end();) {
    const PersonState* const state = person->second.state();
    const bool is_gone =
        state != nullptr && MomentOf(current_) - MomentOf(state->sample) > kForgetAfterNanos;
    if (!is_gone) {
      ++person;
      continue;
    }
    past_.at(person->first) = person->second.past();
    if (maker_) maker_->Forget(past_.at(person->first).index);
    places_.Forget(person->first);
    person = people_.erase(person);
  }
}

void SceneBuilder::TakeTime(const BodySample& sample) {
  current_.stamp_nanos = sample.stamp_nanos;
  current_.arrival_nanos = sample.arrival_nanos;
  current_.waited_nanos = waited_nanos_;
}

// Also in recordings that follow each other.
bool SceneBuilder::IsWithin(std::int64_t nanos, std::int64_t moment) const {
  return std::abs(MomentOf(current_) - moment) <= nanos;
}

const PersonState* SceneBuilder::StateOfPresent(const PersonTracker& person) const {
  const PersonState* const state = person.state();
  const bool is_present = state != nullptr && IsWithin(kGoneAfterNanos, MomentOf(state->sample));
  return is_present ? state : nullptr;
}

bool SceneBuilder::IsPlausible(const BodySample& sample) {
  auto why =
      places_.WhyNot(sample.character, sample.segments[urdf::kPelvis].position, MomentOf(sample));
  const auto known = left_out_.find(sample.character);
  if (!why) {
    if (known != left_out_.end()) left_out_.erase(known);
    return true;
  }
  if (left_out_once_.insert(sample.character).second) {
    const std::string& name = characters_[sample.character].name;
    spdlog::warn("{} is left out: {}; such a place is not possible",
                 name.empty() ? fmt::format("character {}", sample.character) : "'" + name + "'",
                 why->text);
  }
  left_out_[sample.character] = {std::move(*why), MomentOf(sample)};
  // The stream goes on; a person alone is shown at the last plausible place for a second.
  if (current_.liveness == Liveness::kNoData) return false;
  TakeTime(sample);
  Publish(Liveness::kLive);
  return false;
}

void SceneBuilder::OnSample(const BodySample& sample, const loads::BodyMotion* motion) {
  if (!IsPlausible(sample)) return;
  const auto inputs = inputs_.find(sample.character);
  static const PersonInputs kNoInputs;
  const PersonInputs& given = inputs == inputs_.end() ? kNoInputs : inputs->second;
  loads::LoadSettings settings = options_.loads;
  if (!settings.hands.is_known) settings.hands = ToldHandLoadOf(sample.character);
  if (given.hand_load) settings.hands = *given.hand_load;
  settings.strength.sex = StatedOf(sample.character).sex.value_or(settings.strength.sex);
  const bool has_forces = recorded_forces_ && recorded_forces_->AreOf(sample);
  TrackerOf(sample.character)
      .Update(sample, settings, given.measured,
              {options_.floor_z, motion, has_forces ? &*recorded_forces_ : nullptr});
  rate_.Add(sample);
  current_.rate_hz = rate_.hz();
  current_.counter = sample.counter;
  current_.time_code_millis = sample.time_code_millis;
  TakeTime(sample);
  time_origin_ = sample.stamp_nanos - sample.time_code_millis * kNanosPerMilli;
  const auto first = std::find_if(people_.begin(), people_.end(),
                                  [](const auto& entry) { return entry.second.floor_z(); });
  current_.floor_z = *first->second.floor_z();
  Publish(Liveness::kLive);
  ForgetThoseGone();
}

// Objects alone are no motion to show: they wait for the next sample of a person.
void SceneBuilder::OnObjects(const ObjectsSample& sample) {
  const Character& cluster = characters_[sample.character];
  TrackedGroup& group = objects_[sample.character];
  group.moment = MomentOf(sample);
  group.objects.clear();
  for (std::size_t i = 0; i < sample.poses.size(); ++i) {
    if (!sample.present.test(i)) continue;
    const bool has_name =
        i < cluster.scaled_segments.size() && !cluster.scaled_segments[i].name.empty();
    group.objects.push_back(
        {sample.character, static_cast<int>(i),
         has_name ? cluster.scaled_segments[i].name : "object_" + std::to_string(i + 1),
         sample.poses[i], sample.stamp_nanos});
  }
}

bool SceneBuilder::HasSurroundings() const {
  const auto has_place = [](const RobotState& robot) {
    return std::any_of(
        robot.world_from_link.begin(), robot.world_from_link.end(),
        [](const Eigen::Isometry3d& link) { return link.translation().allFinite(); });
  };
  return !current_.markers.empty() || !current_.images.empty() ||
         std::any_of(current_.robots.begin(), current_.robots.end(), has_place);
}

void SceneBuilder::OnMoment(const SourceMoment& moment) {
  const bool is_live = moment.arrival_nanos != 0;
  if (is_live && time_origin_ == 0 && !HasSurroundings()) return;
  if (time_origin_ == 0) time_origin_ = moment.stamp_nanos;
  current_.stamp_nanos = moment.stamp_nanos;
  current_.arrival_nanos = moment.arrival_nanos;
  current_.time_code_millis = (moment.stamp_nanos - time_origin_) / kNanosPerMilli;
  if (past_.empty()) {
    current_.counter = current_.liveness == Liveness::kNoData ? 0 : current_.counter + 1;
  } else {
    rate_.Stop();
    current_.rate_hz = 0;
  }
  const bool has_person = std::any_of(people_.begin(), people_.end(), [&](const auto& each) {
    return StateOfPresent(each.second) != nullptr;
  });
  Publish(has_person ? Liveness::kStale : Liveness::kNoPerson);
}

// Clouds may come thirty times a second, and change little.
void SceneBuilder::FollowExtent() {
  constexpr std::int64_t kEveryNanos = 250 * kNanosPerMilli;
  if (!past_.empty()) {
    current_.extent.setEmpty();
    return;
  }
  const bool is_due = current_.extent.isEmpty() || current_.stamp_nanos == 0 ||
                      std::abs(current_.stamp_nanos - extent_nanos_) >= kEveryNanos;
  if (!is_due) return;
  extent_nanos_ = current_.stamp_nanos;
  current_.extent = extent_.Follow(ExtentOf(current_.robots, current_.markers));
}

void SceneBuilder::Publish(Liveness liveness) {
  current_.liveness = liveness;
  current_.number += 1;
  current_.source = source_;
  if (!robots_.empty() && current_.floor_z != robots_floor_z_) PlaceRobots();
  FollowExtent();
  const auto scene = std::make_shared<SceneState>(current_);
  scene->people.reserve(people_.size());
  for (const auto& [id, person] : people_) {
    const PersonState* const state = StateOfPresent(person);
    if (state == nullptr) continue;
    const auto left_out = left_out_.find(id);
    if (left_out != left_out_.end() && left_out->second.doubt.is_of_person) continue;
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
  if (!scene->people.empty()) {
    scene->view_heading = current_.view_heading = view_heading_.Follow(scene->people.front());
  }
  for (const auto& [id, group] : objects_) {
    if (!IsWithin(kGoneAfterNanos, group.moment)) continue;
    scene->objects.insert(scene->objects.end(), group.objects.begin(), group.objects.end());
  }
  for (const auto& [id, left_out] : left_out_) {
    if (!IsWithin(kGoneAfterNanos, left_out.moment)) continue;
    scene->left_out.push_back({id, characters_[id].name, left_out.doubt.text});
  }
  PlaceCamera(*scene);
  on_state_(scene);
}

// A link of a person is where it is in this very sample; another frame where it was found last.
void SceneBuilder::PlaceCamera(SceneState& scene) {
  const auto& [frame, axes] = options_.camera_frame;
  if (frame.empty()) return;
  for (const PersonState& person : scene.people) {
    for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
      if (urdf::LinkName(person.model->human.model_name, segment) != frame) continue;
      urdf::Pose base = person.links[urdf::At(segment)];
      if (!axes.empty()) base.orientation = scene.camera_base.value_or(urdf::Pose{}).orientation;
      scene.camera_base = current_.camera_base = base;
      return;
    }
  }
  // Frames of TF may come some time after the first sample.
  constexpr double kPatienceSecs = 5;
  if (scene.stamp_nanos == 0) return;
  if (scene.camera_base) {
    if (!std::exchange(misses_camera_, false)) return;
    return spdlog::info("the frame '{}' has come: the camera goes with it",
                        options_.camera_frame.at);
  }
  if (!camera_since_nanos_) camera_since_nanos_ = scene.stamp_nanos;
  if (Secs(scene.stamp_nanos - *camera_since_nanos_) > kPatienceSecs) {
    misses_camera_ = true;
    WarnOfCamera();
  }
}

// Once per program, although a clip is read twice.
void SceneBuilder::WarnOfCamera() const {
  static std::atomic<bool> is_told{false};
  if (options_.camera_frame.at == kUsualFrameOfRviz || is_told.exchange(true)) return;
  spdlog::warn(
      "the frame '{}' of the camera (--camera_tf) has no place in the scene: it has not come, or "
      "TF "
      "has no way from it to the frame that the scene stands in; the camera stands as if it were "
      "at "
      "the origin",
      options_.camera_frame.at);
}

SceneBuilder::~SceneBuilder() {
  if (camera_since_nanos_ && !current_.camera_base) WarnOfCamera();
}

void SceneBuilder::SetRobots(std::vector<RobotState> robots) {
  robots_ = std::move(robots);
  if (!robots_.empty()) PlaceRobots();
}

void SceneBuilder::SetMovingRobots(RobotList robots) {
  node_robots_ = std::move(robots);
  PlaceRobots();
  PublishIfIdle();
}

// Where a robot that moves has its links is part of each state, and no news of its own.
void SceneBuilder::PlaceRobots() {
  std::vector<RobotState> robots;
  for (const RobotState& robot : robots_) robots.push_back(Lifted(robot, current_.floor_z));
  for (const RobotList* const list : {&recorded_.robots, &node_robots_}) {
    for (const auto& robot : *list) robots.push_back(*robot);
  }
  const bool are_the_same =
      current_.floor_z == robots_floor_z_ &&
      std::equal(robots.begin(), robots.end(), current_.robots.begin(), current_.robots.end(),
                 [](const RobotState& a, const RobotState& b) {
                   return a.model == b.model && a.moves == b.moves && a.problem == b.problem;
                 });
  current_.robots = std::move(robots);
  robots_floor_z_ = current_.floor_z;
  if (!are_the_same) current_.surroundings += 1;
}

// What comes while there are no samples is not left to them.
void SceneBuilder::PublishIfIdle() {
  const bool is_idle =
      current_.liveness == Liveness::kNoData || current_.liveness == Liveness::kStale;
  if (is_idle) Publish(current_.liveness);
}

void SceneBuilder::SetMarkers(MarkerList markers) {
  node_markers_ = std::move(markers);
  PlaceMarkers();
  PublishIfIdle();
}

void SceneBuilder::SetCameraBase(const urdf::Pose& pose) {
  current_.camera_base = pose;
  PublishIfIdle();
}

void SceneBuilder::SetImages(ImageList images) {
  node_images_ = std::move(images);
  PlaceImages();
}

void SceneBuilder::PlaceImages() {
  current_.images = recorded_.images;
  current_.images.insert(current_.images.end(), node_images_.begin(), node_images_.end());
  current_.images.resize(std::min(current_.images.size(), kMostImages));
}

void SceneBuilder::OnSurroundings(const RecordedSurroundings& all) {
  const bool has_new_markers = all.markers != recorded_.markers;
  recorded_ = all;
  PlaceImages();
  if (all.camera_base) current_.camera_base = all.camera_base;
  if (has_new_markers) PlaceMarkers();
  PlaceRobots();
}

void SceneBuilder::PlaceMarkers() {
  current_.markers = recorded_.markers;
  current_.markers.insert(current_.markers.end(), node_markers_.begin(), node_markers_.end());
  current_.surroundings += 1;
}

void SceneBuilder::OnCaughtUp() {
  waited_nanos_ = 0;
  const bool was_behind = current_.waited_nanos > kOverloadNanos;
  current_.waited_nanos = 0;
  if (was_behind && current_.liveness != Liveness::kNoData) Publish(current_.liveness);
}

void SceneBuilder::Tick(std::int64_t monotonic_nanos) {
  const bool runs =
      current_.liveness == Liveness::kLive || current_.liveness == Liveness::kNoPerson;
  if (!runs || current_.arrival_nanos == 0) return;
  // Since it was processed: samples that wait in an overloaded machine are no silence.
  const double silent_secs = Secs(monotonic_nanos - current_.arrival_nanos - current_.waited_nanos);
  if (silent_secs >= options_.stale_secs) MarkStale();
}

void SceneBuilder::MarkStale() {
  rate_.Stop();
  current_.rate_hz = 0;
  Publish(Liveness::kStale);
}

}  // namespace kinescope::app
