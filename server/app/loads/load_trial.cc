#include "server/app/loads/load_trial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/compression_limits.h"
#include "core/system/check.h"
#include "core/system/clocks.h"
#include "server/loads/joint_score.h"

namespace kinescope::app {
namespace {

constexpr std::size_t kMaxSlots = 128;  // of scenes kept, some 20 kB each

void Count(std::string_view why, double secs, SecsByReason& reasons) {
  if (!why.empty()) reasons[why] += secs;
}

bool IsKnown(const JointLoad& load) {
  return load.band != LoadClass::kUnknown && std::isfinite(load.ratio);
}

// With the highest known ratio of those that are not left out; nullopt: there is none.
std::optional<std::size_t> HighestJoint(const PersonState& person,
                                        const std::vector<std::size_t>& left_out = {}) {
  std::optional<std::size_t> highest;
  for (std::size_t i = 0; i < person.loads.size(); ++i) {
    const bool is_left_out = std::find(left_out.begin(), left_out.end(), i) != left_out.end();
    if (is_left_out || !IsKnown(person.loads[i])) continue;
    if (!highest || person.loads[i].ratio > person.loads[*highest].ratio) highest = i;
  }
  return highest;
}

}  // namespace

void Peak::Add(double value, std::int64_t stamp_nanos) {
  sum += value;
  if (count++ > 0 && value <= most) return;
  most = value;
  at_nanos = stamp_nanos;
}

void LoadTrial::Add(const std::shared_ptr<const SceneState>& scene, const PersonState& person) {
  const std::int64_t stamp = person.sample.stamp_nanos;
  const double secs_of_last = exposure_.Add(person.loads, stamp);
  if (newest_ != nullptr) CountTime(*newest_, secs_of_last);
  const BodyForces& forces = person.forces;
  if (forces.com_minus_mvn) com_minus_mvn_.Add(forces.com_minus_mvn->norm(), stamp);
  if (forces.lumbar) {
    KeepCompression(scene, person);
    compression_.Add(forces.lumbar->compression, stamp);
    shear_.Add(std::abs(forces.lumbar->shear), stamp);
  }
  KeepTold(person);
  if (keeps_curves_) KeepCurve(person);
  KeepWorst(scene, person);
  KeepPeaks(scene, person);
  scene_ = scene;
  newest_ = &person;
  ++samples_;
}

void LoadTrial::KeepTold(const PersonState& person) {
  const urdf::BodyDescription& body = person.model->description;
  const HandLoad& hands = person.forces.stated_hand_load;
  if (!told_.empty()) {
    const Told& last = told_.back();
    const bool is_same = last.body.mass_kg == body.mass_kg && last.body.sex == body.sex &&
                         last.body.mass_is_assumed == body.mass_is_assumed &&
                         last.body.sex_is_assumed == body.sex_is_assumed &&
                         last.hands.is_known == hands.is_known &&
                         last.hands.mass_kg == hands.mass_kg && last.hands.both_kg == hands.both_kg;
    if (is_same || told_.size() >= kMostTold) return;
  }
  told_.push_back({person.sample.stamp_nanos, body, hands});
}

void LoadTrial::Finish() {
  const double secs_of_last = exposure_.Finish();
  if (newest_ != nullptr) CountTime(*newest_, secs_of_last);
}

double LoadTrial::SecsOf(std::int64_t stamp_nanos) const {
  return Secs(stamp_nanos - begin_nanos_);
}

const PersonState& LoadTrial::newest() const {
  KINESCOPE_CHECK(newest_ != nullptr);
  return *newest_;
}

double LoadTrial::floor_z() const {
  KINESCOPE_CHECK(scene_ != nullptr);
  return scene_->floor_z;
}

bool LoadTrial::knows_anything() const {
  for (std::size_t i = 0; i < urdf::kScoredJoints.size(); ++i) {
    if (exposure_.IsEverKnown(i)) return true;
  }
  return false;
}

void LoadTrial::CountTime(const PersonState& last, double secs) {
  for (std::size_t i = 0; i < last.loads.size(); ++i) {
    Count(last.loads[i].reason, secs, why_unknown_[i]);
  }
  const BodyForces& forces = last.forces;
  if (!forces.is_dynamic) Count(forces.why_static, secs, why_static_);
  Count(forces.why_other_metric, secs, why_other_metric_);
  Count(forces.why_no_ground, secs, why_no_ground_);
  if (forces.ground_is_measured) measured_ground_secs_ += secs;
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    if (forces.hands[side].is_measured) measured_hand_secs_[side] += secs;
  }
  if (forces.com_disagrees) com_disagrees_secs_ += secs;
  if (forces.acceleration_is_limited) limited_secs_ += secs;
  if (forces.is_dynamic && !forces.is_zero_phase) {
    causal_secs_ += secs;
    most_delay_secs_ = std::max(most_delay_secs_, forces.delay_secs);
  }
  if (!forces.lumbar) return;
  if (forces.lumbar->compression > kCompressionLimits[0]) compression_secs_[0] += secs;
  if (forces.lumbar->compression > kCompressionLimits[1]) compression_secs_[1] += secs;
}

void LoadTrial::KeepCurve(const PersonState& person) {
  TrialSample& kept = curves_.emplace_back();
  kept.stamp_nanos = person.sample.stamp_nanos;
  kept.compression = person.forces.lumbar ? static_cast<float>(person.forces.lumbar->compression)
                                          : std::numeric_limits<float>::quiet_NaN();
  kept.is_ground_known = person.forces.why_no_ground.empty();
  for (std::size_t side = 0; side < kept.foot_on_floor.size(); ++side) {
    kept.foot_on_floor[side] = person.forces.feet[side].touches_floor;
    kept.hands_kg += static_cast<float>(person.forces.hands[side].mass_kg);
  }
  for (std::size_t i = 0; i < kept.joints.size(); ++i) {
    const JointLoad& load = person.loads[i];
    const Eigen::Quaterniond& world_from_parent =
        person.links[urdf::At(urdf::ParentOf(load.joint))].orientation;
    kept.joints[i] = {static_cast<float>(load.ratio),
                      (world_from_parent.conjugate() * load.moment).cast<float>(), load.band};
  }
}

void LoadTrial::KeepWorst(const std::shared_ptr<const SceneState>& scene,
                          const PersonState& person) {
  const std::optional<std::size_t> worst = HighestJoint(person);
  if (!worst) return;
  const std::int64_t slot = (person.sample.stamp_nanos - begin_nanos_) / slot_nanos_;
  WorstMoment& best = slots_[slot];
  if (best.scene && person.loads[*worst].ratio <= best.ratio) return;
  best = {person.loads[*worst].ratio, *worst, scene, false};
  if (slots_.size() > kMaxSlots) MergeSlots();
}

void LoadTrial::KeepPeaks(const std::shared_ptr<const SceneState>& scene,
                          const PersonState& person) {
  for (std::size_t i = 0; i < peaks_.size(); ++i) {
    const JointLoad& load = person.loads[i];
    if (!IsKnown(load) || (peaks_[i].scene && load.ratio <= peaks_[i].ratio)) continue;
    peaks_[i] = {load.ratio, i, scene, false};
  }
}

// Before the compression of `person` is added.
void LoadTrial::KeepCompression(const std::shared_ptr<const SceneState>& scene,
                                const PersonState& person) {
  const std::optional<std::size_t> worst = HighestJoint(person);
  const bool is_highest =
      most_compressed_.scene == nullptr || person.forces.lumbar->compression > compression_.most;
  if (!worst || !is_highest) return;
  most_compressed_ = {person.loads[*worst].ratio, *worst, scene, true};
}

void LoadTrial::MergeSlots() {
  std::map<std::int64_t, WorstMoment> merged;
  for (auto& [slot, moment] : slots_) {
    WorstMoment& best = merged[slot / 2];
    if (!best.scene || moment.ratio > best.ratio) best = std::move(moment);
  }
  slots_ = std::move(merged);
  slot_nanos_ *= 2;
}

double LoadTrial::apart_secs() const {
  return std::max(std::clamp(secs() / 3, 0.5, 1.0), secs() / 12);
}

bool LoadTrial::IsApart(const WorstMoment& moment, const std::vector<WorstMoment>& others) const {
  return std::none_of(others.begin(), others.end(), [&](const WorstMoment& other) {
    return std::abs(Secs(moment.scene->stamp_nanos - other.scene->stamp_nanos)) < apart_secs();
  });
}

std::vector<WorstMoment> LoadTrial::Worst(std::size_t count) const {
  std::vector<WorstMoment> moments;
  for (const auto& [slot, moment] : slots_) moments.push_back(moment);
  std::stable_sort(moments.begin(), moments.end(),
                   [](const WorstMoment& a, const WorstMoment& b) { return a.ratio > b.ratio; });
  std::vector<WorstMoment> chosen;
  for (const WorstMoment& moment : moments) {
    if (chosen.size() < count && IsApart(moment, chosen)) chosen.push_back(moment);
  }
  return chosen;
}

std::vector<WorstMoment> LoadTrial::WorstPostures(std::size_t count) const {
  std::vector<WorstMoment> chosen;
  if (most_compressed_.scene && count > 0) chosen.push_back(most_compressed_);
  while (chosen.size() < count) {
    std::optional<WorstMoment> next = NextPosture(chosen);
    if (!next) break;
    chosen.push_back(*std::move(next));
  }
  return chosen;
}

// Of the scenes that were kept: the highest ratio of a joint that none of `before` is about.
std::optional<WorstMoment> LoadTrial::NextPosture(const std::vector<WorstMoment>& before) const {
  std::vector<std::size_t> shown;
  for (const WorstMoment& moment : before) {
    if (!moment.is_of_compression) shown.push_back(moment.joint);
  }
  std::optional<WorstMoment> next;
  const auto consider = [&](const WorstMoment& kept) {
    if (!kept.scene || !IsApart(kept, before)) return;
    for (const PersonState& person : kept.scene->people) {
      if (person.character != newest_->character) continue;
      const std::optional<std::size_t> joint = HighestJoint(person, shown);
      if (!joint || (next && person.loads[*joint].ratio <= next->ratio)) continue;
      next = WorstMoment{person.loads[*joint].ratio, *joint, kept.scene, false};
    }
  };
  for (const WorstMoment& peak : peaks_) consider(peak);
  for (const auto& [slot, moment] : slots_) consider(moment);
  return next;
}

}  // namespace kinescope::app
