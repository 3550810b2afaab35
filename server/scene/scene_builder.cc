#include "server/scene/scene_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/check.h"
#include "core/clocks.h"
#include "server/body/body_color.h"
#include "server/body/figure_files.h"
#include "urdf/robot_model.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;
using urdf::At;
using urdf::LinkPoses;

// A person who sent nothing for this long while others do has left.
constexpr std::int64_t kGoneAfterNanos = 1'000'000'000;

double LowestSole(const LinkPoses& links, const urdf::Skeleton& skeleton) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const urdf::Pose& foot = links[side == urdf::kRight ? urdf::kRightFoot : urdf::kLeftFoot];
    const urdf::Pose& toe = links[side == urdf::kRight ? urdf::kRightToe : urdf::kLeftToe];
    lowest = std::min({lowest, (foot.position + foot.orientation * skeleton.heel_in_foot[side]).z(),
                       (toe.position + toe.orientation * skeleton.toe_tip_in_toe[side]).z()});
  }
  return lowest;
}

JointLoad Unknown(int joint, const Vector3d& position, std::string_view reason) {
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  JointLoad load;
  load.joint = joint;
  load.position = position;
  load.moment = load.force = Vector3d::Constant(kNothing);
  load.ratio = load.deciding_moment = load.capacity = kNothing;
  load.reason = reason;
  return load;
}

}  // namespace

SceneBuilder::SceneBuilder(SceneOptions options, std::string source, double nominal_rate_hz,
                           OnState on_state)
    : options_(std::move(options)),
      source_(std::move(source)),
      nominal_rate_hz_(nominal_rate_hz),
      on_state_(std::move(on_state)) {
  SetLoads(options_.loads);
}

void SceneBuilder::SetLoads(const loads::LoadSettings& settings) {
  KINESCOPE_CHECK(loads::FindDefect(settings).empty());
  options_.loads = settings;
  options_.loads.strength.sex = options_.body.sex;
  current_.class_limits = settings.classes.up;
}

void SceneBuilder::SetMeasurements(int character, const loads::Measurements& measured) {
  measured_[character] = measured;
  LetGoOfStoppedHands(character);
}

void SceneBuilder::SetHandLoad(int character, const HandLoad& load) {
  KINESCOPE_CHECK(loads::FindDefect(load).empty());
  held_[character] = {load, current_.stamp_nanos};
  LetGoOfStoppedHands(character);
}

// A sensor that has stopped leaves a hand's load unknown until somebody says what it is.
void SceneBuilder::LetGoOfStoppedHands(int character) {
  const auto told = held_.find(character);
  const auto measured = measured_.find(character);
  if (told == held_.end() || measured == measured_.end()) return;
  const std::int64_t told_nanos = told->second.told_nanos;
  for (auto& hand : measured->second.hands) {
    const bool came_before = hand && hand->stamp_nanos < told_nanos;
    if (came_before && !loads::IsFresh(hand->stamp_nanos, told_nanos)) hand.reset();
  }
}

void SceneBuilder::Start() { Publish(Liveness::kNoData); }

SceneBuilder::Person& SceneBuilder::AddPerson(const Character& character) {
  Person& person = people_[character.id];
  person.character = character;
  person.index = people_.size() - 1;
  person.model = MakeModel(person);
  return person;
}

std::shared_ptr<const PersonModel> SceneBuilder::MakeModel(const Person& person) const {
  auto model = std::make_shared<PersonModel>();
  if (person.model) {
    model->revision = person.model->revision + 1;
    model->human.model_name = person.model->human.model_name;
  } else {
    model->revision = 1;
    model->human.model_name = person.index == 0
                                  ? options_.model_name
                                  : options_.model_name + "_" + std::to_string(person.index);
  }
  model->description = options_.body;
  model->lengths_are_measured = person.character.skeleton.has_value();
  model->human.skeleton =
      person.character.skeleton.value_or(urdf::DefaultSkeleton(options_.height_m));
  if (person.l5_from_poses) {
    model->human.skeleton.origin_in_parent[urdf::kL5] = *person.l5_from_poses;
  }
  model->human.body = urdf::MakeBodyParameters(options_.body, model->human.skeleton);
  model->human.body_rgb = BodyColor(person.character.color_rgb, person.index);
  person.worn.AddTo(person.character, model->human);
  if (options_.smooth_figure) {
    model->human.mesh_folder =
        WriteToCache(FigureFiles(model->human, options_.figure_meshes.get()));
  }
  if (options_.tools) {
    model->human.tool_folder = WriteToCache(ToolFiles(*options_.tools, model->human.skeleton));
    for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
      model->human.tools.set(side, (*options_.tools)[side] && !model->human.tool_folder.empty());
    }
  }
  model->urdf_xml = urdf::WriteUrdf(model->human);
  model->robot = urdf::ParseUrdf(model->urdf_xml);
  return model;
}

void SceneBuilder::OnCharacter(const Character& character) {
  if (!character.skeleton && !character.scaled_segments.empty()) {
    clusters_[character.id] = character;
    return;
  }
  const auto known = people_.find(character.id);
  if (known == people_.end()) {
    AddPerson(character);
    return;
  }
  Person& person = known->second;
  const bool same_body = person.character.skeleton == character.skeleton;
  const bool same_segments = person.character.scaled_segments == character.scaled_segments;
  const bool same_color = person.character.color_rgb == character.color_rgb;
  person.character = character;
  if (!same_body) {
    person.l5_is_checked = false;
    person.l5_from_poses.reset();
  }
  const bool is_told_more = character.skeleton && !(same_body && same_segments);
  if (!is_told_more && same_color) return;
  person.model = MakeModel(person);
  if (same_body) return;
  person.floor_z.reset();  // judged by the soles, which have just moved
  person.worst_deviation = {};
}

// Scale data without points can have L5 a centimetre and more off where all poses have it (a tilted
// pelvis that the T-pose calls upright), and with it everything above. True when the poses are
// followed.
bool SceneBuilder::CheckL5(const BodySample& sample, Person& person) {
  if (person.l5_is_checked || !person.character.skeleton) return false;
  person.l5_is_checked = true;
  constexpr double kAgrees = 0.005, kNoLongerL5 = 0.03;  // m
  const SegmentState& pelvis = sample.segments[urdf::kPelvis];
  const Vector3d measured =
      pelvis.orientation.conjugate() * (sample.segments[urdf::kL5].position - pelvis.position);
  const double off = (measured - person.character.skeleton->origin_in_parent[urdf::kL5]).norm();
  if (off < kAgrees || off > kNoLongerL5) return false;
  person.l5_from_poses = measured;
  return true;
}

PersonState SceneBuilder::StateOf(Person& person, const BodySample& sample) const {
  const urdf::Skeleton& skeleton = person.model->human.skeleton;
  PersonState state;
  state.character = sample.character;
  state.name = person.character.name;
  state.model = person.model;
  state.sample = sample;
  state.links = LinkPosesOf(sample);
  state.angles = person.angles = urdf::AnglesFromPoses(state.links, person.angles);
  state.deviation = urdf::MeasureDeviation(skeleton, state.links, state.angles);
  person.worst_deviation.Raise(state.deviation);
  state.worst_deviation = person.worst_deviation;
  person.worn.Follow(sample, state);

  if (!person.floor_z) {
    // Without leg sensors MVN keeps the pelvis near z = 0 and hangs rigid legs below it; with them
    // the floor is z = 0.
    const double lowest = LowestSole(state.links, skeleton);
    person.has_legs = lowest > -0.3;
    person.floor_z = person.has_legs ? 0.0 : lowest;
  }

  const urdf::HumanModel& human = person.model->human;
  const urdf::BodyDescription& body = person.model->description;
  static const loads::Measurements kNothingMeasured;
  const auto measured = measured_.find(sample.character);
  loads::LoadSettings settings = options_.loads;
  if (const auto held = held_.find(sample.character); held != held_.end()) {
    settings.hands = held->second.load;
  }
  const loads::LoadResult& result = person.loads.Update(
      sample, state.links,
      {human.skeleton, human.body, body.mass_is_assumed, !body.added_masses.empty(),
       person.has_legs, *person.floor_z},
      settings, measured == measured_.end() ? kNothingMeasured : measured->second);
  state.com_is_ours = !sample.com;
  state.com = sample.com ? sample.com->position : result.forces.com_of_model;
  state.cop = result.cop;
  person.exposure.Add(result.loads, sample.stamp_nanos);
  state.loads.assign(result.loads.begin(), result.loads.end());
  for (std::size_t i = 0; i < state.loads.size(); ++i) {
    state.loads[i].class_secs = person.exposure.SecsOf(i);
  }
  state.forces = result.forces;
  return state;
}

void SceneBuilder::OnSample(const BodySample& sample) {
  const auto known = people_.find(sample.character);
  Person& person =
      known != people_.end() ? known->second : AddPerson({sample.character, "", {}, {}, {}});
  const bool l5_moved = CheckL5(sample, person);
  if (person.worn.Notice(sample) || l5_moved) person.model = MakeModel(person);
  person.state = StateOf(person, sample);
  MeasureRate(sample);
  current_.stamp_nanos = sample.stamp_nanos;
  current_.counter = sample.counter;
  current_.time_code_millis = sample.time_code_millis;
  current_.arrival_nanos = sample.arrival_nanos;
  const auto first = std::find_if(people_.begin(), people_.end(),
                                  [](const auto& entry) { return entry.second.floor_z; });
  current_.floor_z = *first->second.floor_z;
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

// One person's samples are counted, whoever begins the window: two people at 60 Hz are 60 Hz.
void SceneBuilder::MeasureRate(const BodySample& sample) {
  const bool is_file = sample.arrival_nanos == 0;
  if (is_file && nominal_rate_hz_ > 0) {
    current_.rate_hz = nominal_rate_hz_;
    return;
  }
  const std::int64_t now = is_file ? sample.stamp_nanos : sample.arrival_nanos;
  const double secs = Secs(now - rate_window_start_);
  constexpr double kLongestWindow = 2;  // whom we counted has left
  if (rate_window_start_ == 0 || current_.liveness != Liveness::kLive || secs > kLongestWindow) {
    rate_window_start_ = now;
    rate_window_samples_ = 0;
    rate_character_ = sample.character;
    return;
  }
  if (sample.character != rate_character_) return;
  ++rate_window_samples_;
  // Not sooner, not even the first time: samples that waited in the socket while the program
  // started come at once, and would be a quarter of a short window.
  if (secs >= 1.0) {
    current_.rate_hz = rate_window_samples_ / secs;
    rate_window_start_ = now;
    rate_window_samples_ = 0;
  }
}

void SceneBuilder::Publish(Liveness liveness) {
  current_.liveness = liveness;
  current_.number += 1;
  current_.source = source_;
  const auto scene = std::make_shared<SceneState>(current_);
  for (const auto& [id, person] : people_) {
    if (!person.state) continue;
    if (current_.stamp_nanos - person.state->sample.stamp_nanos > kGoneAfterNanos) continue;
    scene->people.push_back(*person.state);
    if (liveness == Liveness::kLive) continue;
    constexpr std::string_view kStopped = "the stream stopped";  // old loads must not look valid
    for (JointLoad& load : scene->people.back().loads) {
      const std::array<double, 4> class_secs = load.class_secs;
      load = Unknown(load.joint, load.position, kStopped);
      load.class_secs = class_secs;
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
  current_.rate_hz = 0;
  Publish(Liveness::kStale);
}

}  // namespace kinescope::app
