#include "server/app/loads/load_trial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/system/check.h"
#include "core/system/clocks.h"
#include "server/loads/gap.h"
#include "server/loads/joint_score.h"

namespace kinescope::app {
namespace {

constexpr std::size_t kMaxSlots = 128;  // of scenes kept, some 20 kB each

void Count(std::string_view why, double secs, SecsByReason& reasons) {
  if (!why.empty()) reasons[why] += secs;
}

}  // namespace

bool IsWorse(const WorstMoment& a, const WorstMoment& b) {
  return std::tie(a.load_class, a.severity) > std::tie(b.load_class, b.severity);
}

void Peak::Add(double value, std::int64_t stamp_nanos) {
  sum += value;
  if (count++ > 0 && value <= most) return;
  most = value;
  at_nanos = stamp_nanos;
}

void LoadTrial::Add(const std::shared_ptr<const SceneState>& scene, const PersonState& person) {
  const std::int64_t stamp = person.sample.stamp_nanos;
  if (newest_ != nullptr) {
    const double step = Secs(stamp - newest_->sample.stamp_nanos);
    if (step > 0) CountTime(*newest_, std::min(step, loads::kLongestGapSecs));
  }
  exposure_.Add(person.loads, stamp);
  const BodyForces& forces = person.forces;
  if (forces.com_minus_mvn) com_minus_mvn_.Add(forces.com_minus_mvn->norm(), stamp);
  if (forces.lumbar) {
    compression_.Add(forces.lumbar->compression, stamp);
    shear_.Add(std::abs(forces.lumbar->shear), stamp);
  }
  if (keeps_curves_) KeepCurve(person);
  KeepWorst(scene, person);
  scene_ = scene;
  newest_ = &person;
  ++samples_;
}

double LoadTrial::SecsOf(std::int64_t stamp_nanos) const {
  return Secs(stamp_nanos - begin_nanos_);
}

const PersonState& LoadTrial::newest() const {
  KINESCOPE_CHECK(newest_ != nullptr);
  return *newest_;
}

bool LoadTrial::knows_anything() const {
  for (std::size_t i = 0; i < urdf::kScoredJoints.size(); ++i) {
    if (std::isfinite(exposure_.Of(i).peak_ratio)) return true;
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
  if (forces.com_disagrees) com_disagrees_secs_ += secs;
  if (!forces.lumbar) return;
  if (forces.lumbar->compression > loads::kCompressionLimits[0]) compression_secs_[0] += secs;
  if (forces.lumbar->compression > loads::kCompressionLimits[1]) compression_secs_[1] += secs;
}

void LoadTrial::KeepCurve(const PersonState& person) {
  TrialSample& kept = curves_.emplace_back();
  kept.stamp_nanos = person.sample.stamp_nanos;
  kept.compression = person.forces.lumbar ? static_cast<float>(person.forces.lumbar->compression)
                                          : std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < kept.joints.size(); ++i) {
    const JointLoad& load = person.loads[i];
    const Eigen::Quaterniond& world_from_parent =
        person.links[urdf::At(urdf::ParentOf(load.joint))].orientation;
    kept.joints[i] = {static_cast<float>(load.ratio),
                      (world_from_parent.conjugate() * load.moment).cast<float>(), load.load_class};
  }
}

void LoadTrial::KeepWorst(const std::shared_ptr<const SceneState>& scene,
                          const PersonState& person) {
  WorstMoment worst;
  const auto raise = [&](const WorstMoment& moment) {
    if (moment.load_class != LoadClass::kUnknown && IsWorse(moment, worst)) worst = moment;
  };
  for (std::size_t i = 0; i < person.loads.size(); ++i) {
    raise({person.loads[i].load_class, person.loads[i].ratio, i, false, nullptr});
  }
  // Where the class of L5/S1 is that of its compression, so is its severity.
  const JointLoad& lumbar = person.loads[urdf::kScoredL5S1];
  if (lumbar.class_is_of_compression && person.forces.lumbar) {
    raise({lumbar.load_class, loads::LumbarRatio(*person.forces.lumbar), urdf::kScoredL5S1, true,
           nullptr});
  }
  if (worst.load_class == LoadClass::kUnknown) return;
  const std::int64_t slot = (person.sample.stamp_nanos - begin_nanos_) / slot_nanos_;
  WorstMoment& best = slots_[slot];
  if (best.scene && !IsWorse(worst, best)) return;
  best = worst;
  best.scene = scene;
  if (slots_.size() > kMaxSlots) MergeSlots();
}

void LoadTrial::MergeSlots() {
  std::map<std::int64_t, WorstMoment> merged;
  for (auto& [slot, moment] : slots_) {
    WorstMoment& best = merged[slot / 2];
    if (!best.scene || IsWorse(moment, best)) best = std::move(moment);
  }
  slots_ = std::move(merged);
  slot_nanos_ *= 2;
}

std::vector<WorstMoment> LoadTrial::Worst(std::size_t count) const {
  std::vector<WorstMoment> moments;
  for (const auto& [slot, moment] : slots_) moments.push_back(moment);
  std::stable_sort(moments.begin(), moments.end(), &IsWorse);
  const double apart = std::max(0.5, secs() / 12);
  std::vector<WorstMoment> chosen;
  for (const WorstMoment& moment : moments) {
    const bool is_new = std::none_of(chosen.begin(), chosen.end(), [&](const WorstMoment& other) {
      return std::abs(Secs(moment.scene->stamp_nanos - other.scene->stamp_nanos)) < apart;
    });
    if (is_new && chosen.size() < count) chosen.push_back(moment);
  }
  return chosen;
}

}  // namespace kinescope::app
