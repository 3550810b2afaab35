#include "server/scene/person_tracker.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "urdf/kinematics.h"

namespace kinescope::app {

PersonTracker::PersonTracker(const ModelFactory& models, ModelMaker* maker, Character character,
                             const Past& past)
    : models_(models), maker_(maker), revision_(past.revision), exposure_(past.exposure) {
  person_.index = past.index;
  person_.character = std::move(character);
}

// Brings the model up to date, or on the way. Changes while one is being made are in the next one,
// all together.
void PersonTracker::UpdateModel() {
  if (model_ != nullptr && maker_ != nullptr) {
    if (auto made = maker_->Take(person_.index)) SetModel(std::move(made));
    if (!has_changed_ || !maker_->IsFree(person_.index)) return;
    maker_->Ask(person_, ++revision_);
    has_changed_ = false;
  } else if (has_changed_) {
    has_changed_ = false;
    SetModel(models_.Make(person_, ++revision_));
  }
}

void PersonTracker::SetModel(std::shared_ptr<const PersonModel> model) {
  model_ = std::move(model);
  if (!has_new_lengths_) return;
  has_new_lengths_ = has_changed_;
  floor_.Restart();  // found by the soles, which have just moved
  worst_deviation_ = {};
}

void PersonTracker::SetCharacter(const Character& received) {
  Character character = received;
  if (character.skeleton) {
    person_.lengths_are_of_poses = false;
  } else if (person_.lengths_are_of_poses) {
    character.skeleton = person_.character.skeleton;
  }
  const bool same_body = person_.character.skeleton == character.skeleton;
  const bool same_extra = person_.character.scaled_segments == character.scaled_segments &&
                          person_.character.landmarks == character.landmarks;
  const bool same_color = person_.character.color_rgb == character.color_rgb;
  person_.character = character;
  if (!same_body) {
    watch_ = SkeletonWatch();
    is_watched_ = false;
    l5_is_checked_ = false;
    person_.l5_in_pelvis.reset();
  }
  const bool has_more_lengths = character.skeleton && !(same_body && same_extra);
  if (!has_more_lengths && same_color) return;
  if (!same_body) has_new_lengths_ = true;
  has_changed_ = true;
}

void PersonTracker::SetStated(const PersonChange& stated) {
  const PersonChange& before = person_.stated;
  const bool same_height = before.height_m == stated.height_m;
  if (before.mass_kg != stated.mass_kg || before.sex != stated.sex || !same_height) {
    has_changed_ = true;
  }
  if (!same_height && !person_.character.skeleton) has_new_lengths_ = true;
  person_.stated = stated;
}

// Scale data without points can have L5 a centimetre and more off where all poses have it (a tilted
// pelvis that the T-pose calls upright), and with it everything above. True when the poses are
// followed.
bool PersonTracker::CheckL5(const BodySample& sample) {
  const std::optional<urdf::Skeleton>& skeleton = person_.character.skeleton;
  if (l5_is_checked_ || !skeleton) return false;
  l5_is_checked_ = true;
  constexpr double kAgrees = 0.005, kNoLongerL5 = 0.03;  // m
  const SegmentState& pelvis = sample.segments[urdf::kPelvis];
  const Eigen::Vector3d measured =
      pelvis.orientation.conjugate() * (sample.segments[urdf::kL5].position - pelvis.position);
  const double off = (measured - skeleton->origin_in_parent[urdf::kL5]).norm();
  if (off < kAgrees || off > kNoLongerL5) return false;
  person_.l5_in_pelvis = measured;
  return true;
}

bool PersonTracker::MeasureSkeleton(const BodySample& sample) {
  const auto measured = watch_.Look(sample);
  if (!measured) return false;
  if (person_.character.skeleton && !person_.lengths_are_of_poses) {
    if (is_watched_) WarnOfOtherLengths(*measured);
    is_watched_ = true;
    return false;
  }
  person_.character.skeleton = *measured;
  person_.lengths_are_of_poses = true;
  l5_is_checked_ = true;
  person_.l5_in_pelvis.reset();
  has_new_lengths_ = true;
  return true;
}

void PersonTracker::WarnOfOtherLengths(const urdf::Skeleton& measured) const {
  double most = 0;
  for (std::size_t i = 0; i < measured.origin_in_parent.size(); ++i) {
    most = std::max(most, std::abs(measured.origin_in_parent[i].norm() -
                                   person_.character.skeleton->origin_in_parent[i].norm()));
  }
  const Character& character = person_.character;
  spdlog::warn(
      "the segments of {} have other lengths now, by up to {:.0f} cm, and no scale data came with "
      "them: body and loads are those of before; let MVN stream scale data if another person wears "
      "the suit",
      character.name.empty() ? "character " + std::to_string(character.id)
                             : "'" + character.name + "'",
      100 * most);
}

// Without leg sensors MVN keeps the pelvis near z = 0 and hangs straight legs below it, which never
// bend.
bool PersonTracker::LegsHang(const urdf::LinkPoses& links) {
  constexpr double kFarthestPelvis = 0.2, kMostBend = 2e-3;  // m, rad
  if (std::abs(links[urdf::kPelvis].position.z()) > kFarthestPelvis) return false;
  for (const int joint : {urdf::jRightHip, urdf::jRightKnee, urdf::jRightAnkle, urdf::jLeftHip,
                          urdf::jLeftKnee, urdf::jLeftAnkle}) {
    const Eigen::Quaterniond& parent = links[urdf::At(urdf::ParentOf(joint))].orientation;
    const Eigen::Quaterniond& child = links[urdf::At(urdf::ChildOf(joint))].orientation;
    if (!(2 * (parent.conjugate() * child).vec().norm() < kMostBend)) return false;
  }
  return true;
}

void PersonTracker::FindFloor(const BodySample& sample, const urdf::LinkPoses& links,
                              std::optional<double> given) {
  if (!has_legs_) has_legs_ = !LegsHang(links);
  feet_.Update(sample, links, model_->human.skeleton);
  std::array<double, 2> lowest{}, speeds{};
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const loads::FootPoint forefoot = feet_.lower_forefoot(side);
    const bool is_heel = feet_.at(side, loads::kHeelPoint).z() < feet_.at(side, forefoot).z();
    const loads::FootPoint point = is_heel ? loads::kHeelPoint : forefoot;
    lowest[side] = feet_.at(side, point).z();
    speeds[side] = feet_.speed(side, point);
  }
  floor_.Add(sample.stamp_nanos, lowest, speeds);
  floor_z_ = given ? *given : has_legs_ ? floor_.height() : std::min(lowest[0], lowest[1]);
  why_no_floor_ = given || (has_legs_ && floor_.is_found()) ? ""
                  : has_legs_                               ? "no foot has rested for 0.3 s"
                              : "the source does not measure the legs";
}

void PersonTracker::AddLoads(const BodySample& sample, const loads::LoadSettings& settings,
                             const loads::Measurements& measured, const loads::BodyMotion* motion,
                             PersonState& state) {
  const urdf::HumanModel& human = model_->human;
  const urdf::BodyDescription& body = model_->description;
  const loads::LoadResult& result =
      loads_.Update(sample, state.links,
                    {human.skeleton, human.body, body.mass_is_assumed, !body.added_masses.empty(),
                     has_legs_, *floor_z_, why_no_floor_},
                    settings, measured, motion);
  state.com_is_ours = !sample.com;
  state.com = sample.com ? sample.com->position : result.forces.com_of_model;
  state.cop = result.cop;
  exposure_.Add(result.loads, sample.stamp_nanos);
  state.loads.assign(result.loads.begin(), result.loads.end());
  for (std::size_t i = 0; i < state.loads.size(); ++i) {
    state.loads[i].band_secs = exposure_.SecsOf(i);
  }
  state.forces = result.forces;
}

void PersonTracker::Update(const BodySample& sample, const loads::LoadSettings& settings,
                           const loads::Measurements& measured, const Known& known) {
  const bool has_new_lengths = MeasureSkeleton(sample);
  const bool l5_has_moved = CheckL5(sample);
  if (person_.worn.Notice(sample) || has_new_lengths || l5_has_moved) has_changed_ = true;
  UpdateModel();
  PersonState state;
  state.character = sample.character;
  state.name = person_.stated.name.value_or(person_.character.name);
  state.model = model_;
  state.sample = sample;
  state.links = LinkPosesOf(sample);
  state.angles = angles_ = urdf::AnglesFromPoses(state.links, angles_);
  state.deviation = urdf::MeasureDeviation(model_->human.skeleton, state.links, state.angles);
  worst_deviation_.Raise(state.deviation);
  state.worst_deviation = worst_deviation_;
  person_.worn.Follow(sample, state);
  FindFloor(sample, state.links, known.floor_z);
  if (known.forces == nullptr) {
    AddLoads(sample, settings, measured, known.motion, state);
  } else {
    AddLoads(sample, settings, known.forces->At(sample, state.links, *floor_z_), known.motion,
             state);
  }
  state_ = std::move(state);
}

}  // namespace kinescope::app
