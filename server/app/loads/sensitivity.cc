#include "server/app/loads/sensitivity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/compression_limits.h"
#include "core/system/clocks.h"
#include "server/loads/exposure.h"
#include "server/loads/joint_score.h"
#include "server/source/open_source.h"

namespace kinescope::app {
namespace {

constexpr double kVariedShare = 0.1;   // of body mass and hand loads
constexpr double kLeastVariedKg = 1;   // of hand loads
constexpr double kSupposedHandKg = 5;  // where the hand load is unknown

double AllKg(const HandLoad& hands) {
  return hands.mass_kg[urdf::kRight] + hands.mass_kg[urdf::kLeft] + hands.both_kg;
}

void VaryMass(const SceneOptions& scene, std::vector<Variation>& variations) {
  for (const double sign : {-1.0, 1.0}) {
    Variation varied{"", scene};
    varied.of = Variation::Of::kMass;
    varied.factor = 1 + sign * kVariedShare;
    varied.scene.body.mass_kg *= varied.factor;
    varied.scene.supposed.mass_factor = varied.factor;
    if (!urdf::FindDefect(varied.scene.body).empty()) continue;
    varied.label = fmt::format("mass {:.4g} kg ({}{:.0f} %)", varied.scene.body.mass_kg,
                               sign < 0 ? "−" : "+", 100 * kVariedShare);
    variations.push_back(std::move(varied));
  }
}

// What it is, the recording says.
void VaryToldHands(const SceneOptions& scene, std::vector<Variation>& variations) {
  Variation supposed{fmt::format("hand load {:g} kg, both", kSupposedHandKg), scene,
                     Variation::Of::kUnknownHandLoad};
  supposed.scene.supposed.hand_load.is_known = true;
  supposed.scene.supposed.hand_load.both_kg = kSupposedHandKg;
  variations.push_back(std::move(supposed));
  for (const double sign : {-1.0, 1.0}) {
    Variation varied{"", scene, Variation::Of::kHandLoad, 1 + sign * kVariedShare};
    varied.scene.supposed.hand_load_factor = varied.factor;
    variations.push_back(std::move(varied));
  }
}

void VaryHands(const SceneOptions& scene, std::vector<Variation>& variations) {
  const HandLoad& hands = scene.loads.hands;
  const double all_kg = AllKg(hands);
  if (!hands.is_known) {
    Variation varied{fmt::format("hand load {:g} kg, both", kSupposedHandKg), scene};
    varied.scene.loads.hands.is_known = true;
    varied.scene.loads.hands.both_kg = kSupposedHandKg;
    variations.push_back(std::move(varied));
  }
  if (all_kg <= 0) return;
  const double step_kg = std::max(kVariedShare * all_kg, kLeastVariedKg);
  for (const double sign : {-1.0, 1.0}) {
    const double factor = std::max(0.0, 1 + sign * step_kg / all_kg);
    Variation varied{fmt::format("hand load {:.4g} kg ({}{:.3g} kg)", factor * all_kg,
                                 sign < 0 ? "−" : "+", std::abs(factor - 1) * all_kg),
                     scene};
    HandLoad& changed = varied.scene.loads.hands;
    for (double& kg : changed.mass_kg) kg *= factor;
    changed.both_kg *= factor;
    if (loads::FindDefect(changed).empty()) variations.push_back(std::move(varied));
  }
}

}  // namespace

std::vector<Variation> VariationsOf(const SceneOptions& scene, bool may_be_told) {
  std::vector<Variation> variations;
  VaryMass(scene, variations);
  if (may_be_told && !scene.loads.hands.is_known) {
    VaryToldHands(scene, variations);
  } else {
    VaryHands(scene, variations);
  }
  const auto vary = [&](std::string label) -> SceneOptions& {
    return variations.emplace_back(Variation{std::move(label), scene}).scene;
  };
  if (scene.body.table == urdf::BodyTable::kWinter) {
    vary("segment masses: de Leva").body.table = urdf::BodyTable::kDeLeva;
  } else {
    vary("segment masses: Winter").body.table = urdf::BodyTable::kWinter;
  }
  const bool is_dynamic = scene.loads.motion.dynamic;
  vary(is_dynamic ? "without accelerations" : "with accelerations").loads.motion.dynamic =
      !is_dynamic;
  if (scene.loads.strength.percentile == loads::Percentile::k50) {
    vary("strength: weakest 5 %").loads.strength.percentile = loads::Percentile::k5;
  } else {
    vary("strength: median").loads.strength.percentile = loads::Percentile::k50;
  }
  // Nothing of them is shown.
  for (Variation& variation : variations) variation.scene.mesh_cache = nullptr;
  return variations;
}

void StatedKg::Add(bool is_known, double kg) {
  is_known_ = is_known_ || is_known;
  least_ = std::min(least_, kg);
  most_ = std::max(most_, kg);
}

void LoadTally::Add(const PersonState& person) {
  ++row_.samples;
  const urdf::BodyDescription& body = person.model->description;
  mass_.Add(!body.mass_is_assumed, body.mass_kg);
  const HandLoad& hands = person.forces.stated_hand_load;
  hand_load_.Add(hands.is_known, AllKg(hands));
  for (std::size_t i = 0; i < person.loads.size(); ++i) {
    const JointLoad& load = person.loads[i];
    if (load.band == LoadClass::kUnknown) continue;
    row_.is_known[i] = true;
    if (load.band != LoadClass::kLow) ++row_.above[0][i];
    if (load.band == LoadClass::kHigh) ++row_.above[1][i];
  }
  const JointLoad& low_back = person.loads[urdf::kScoredL5S1];
  if (low_back.band != LoadClass::kUnknown && std::isfinite(low_back.ratio)) {
    low_back_ratios_.push_back(static_cast<float>(low_back.ratio));
  }
  if (!person.forces.lumbar) return;
  const double compression = person.forces.lumbar->compression;
  ++row_.compressions;
  if (compression > kCompressionLimits[0]) ++row_.above_action_limit;
  row_.peak_compression = std::fmax(row_.peak_compression, compression);
}

SensitivityRow LoadTally::Row(std::string label) const {
  constexpr std::size_t kPercent = 90;
  SensitivityRow row = row_;
  row.label = std::move(label);
  std::vector<float> ratios = low_back_ratios_;
  row.low_back_p90 = loads::NearestRank(ratios, kPercent);
  return row;
}

Sensitivity::Sensitivity(const SceneOptions& scene, std::optional<double> length_secs,
                         SceneReader& reader)
    : mass_is_option_(!scene.body.mass_is_assumed),
      hand_load_is_option_(scene.loads.hands.is_known),
      length_secs_(length_secs) {
  const std::vector<Variation> variations = VariationsOf(scene, IsBag(reader.url()));
  runs_.resize(variations.size());
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    runs_[i].of = variations[i].of;
    runs_[i].label = variations[i].label;
    runs_[i].factor = variations[i].factor;
    reader.Also(variations[i].scene, [this, i](const std::shared_ptr<const SceneState>& state) {
      Add(*state, runs_[i]);
    });
  }
}

void Sensitivity::Add(const SceneState& scene, Run& run) const {
  if (scene.liveness != Liveness::kLive) return;
  if (!run.begin_nanos) run.begin_nanos = scene.stamp_nanos;
  // The reader is ahead of the trial, which ends there.
  if (!IsWithinLength(*run.begin_nanos, scene.stamp_nanos, length_secs_)) return;
  for (const PersonState& person : scene.people) {
    if (run.fresh.IsNew(person)) run.people[person.character].Add(person);
  }
}

std::string Sensitivity::LabelOf(const Run& run, const LoadTally& as_computed,
                                 const LoadTally& varied) const {
  const auto with_share = [&](const char* what, const StatedKg& stated) {
    const std::string share =
        fmt::format("{}{:.0f} %", run.factor < 1 ? "−" : "+", 100 * std::abs(run.factor - 1));
    if (stated.changes()) return fmt::format("{} ({})", what, share);
    return fmt::format("{} {:.4g} kg ({})", what, stated.most(), share);
  };
  switch (run.of) {
    case Variation::Of::kMass:
      if (mass_is_option_ || !as_computed.mass().is_known()) return run.label;
      return with_share("mass", varied.mass());
    case Variation::Of::kHandLoad:
      if (hand_load_is_option_) return run.label;
      return as_computed.hand_load().most() > 0 ? with_share("hand load", varied.hand_load()) : "";
    case Variation::Of::kUnknownHandLoad:
      return as_computed.hand_load().is_known() ? "" : run.label;
    case Variation::Of::kOther: break;
  }
  return run.label;
}

std::vector<SensitivityRow> Sensitivity::RowsOf(int character) const {
  std::vector<SensitivityRow> rows;
  const auto computed = as_computed_.find(character);
  if (computed == as_computed_.end()) return rows;
  rows.push_back(computed->second.Row("as computed"));
  for (const Run& run : runs_) {
    const auto person = run.people.find(character);
    if (person == run.people.end()) continue;
    const std::string label = LabelOf(run, computed->second, person->second);
    if (!label.empty()) rows.push_back(person->second.Row(label));
  }
  return rows;
}

}  // namespace kinescope::app
