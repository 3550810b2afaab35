#include "server/app/loads/load_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/compression_limits.h"
#include "core/system/json_text.h"
#include "server/loads/joint_score.h"
#include "server/table/load_rows.h"

namespace kinescope::app {
namespace {

// Shares of nothing are nothing.
double Share(double part, double all) { return all > 0 ? part / all : 0; }

const char* Name(loads::Percentile percentile) {
  switch (percentile) {
    case loads::Percentile::k5: return "5th";
    case loads::Percentile::k95: return "95th";
    case loads::Percentile::k50: break;
  }
  return "50th";
}

std::string HandsText(const loads::HandLoad& hands) {
  if (!hands.is_known) return "nothing";
  std::string text;
  const auto add = [&](const char* where, double mass) {
    if (mass > 0) text += fmt::format("{}{:g} kg {}", text.empty() ? "" : ", ", mass, where);
  };
  add("right", hands.mass_kg[urdf::kRight]);
  add("left", hands.mass_kg[urdf::kLeft]);
  add("both hands", hands.both_kg);
  return text.empty() ? "nothing" : text;
}

std::string AddedMassText(const urdf::BodyDescription& body) {
  std::string text;
  for (const urdf::AddedMass& added : body.added_masses) {
    text += fmt::format("{}{:g} kg on {}", text.empty() ? "" : ", ", added.mass_kg,
                        urdf::kSegments[urdf::At(added.segment)].link_name);
  }
  return text;
}

// "forces.csv: ground for 100 % of the time, left hand for 20 %".
std::string MeasuredText(const LoadTrial& trial, const std::string& path) {
  std::string text;
  const auto add = [&](const char* where, double secs) {
    if (secs <= 0) return;
    text += fmt::format("{}{} for {:.0f} %{}", text.empty() ? ": " : ", ", where,
                        100 * Share(secs, trial.secs()), text.empty() ? " of the time" : "");
  };
  add("ground", trial.measured_ground_secs());
  add("right hand", trial.measured_hand_secs()[urdf::kRight]);
  add("left hand", trial.measured_hand_secs()[urdf::kLeft]);
  return std::filesystem::path(path).filename().string() +
         (text.empty() ? ": none at the times of this person's samples" : text);
}

void NoteAssumed(const std::vector<Fact>& facts, std::vector<std::string>& notes) {
  std::string assumed;
  for (const Fact& fact : facts) {
    if (!fact.is_assumed) continue;
    assumed += fmt::format("{}{}: {}", assumed.empty() ? "" : "; ", fact.label, fact.value);
  }
  if (!assumed.empty()) notes.push_back(fmt::format("Assumed (not specified): {}.", assumed));
}

// `beginning`: "Static", with the share of the time and the reason after it.
void NoteTimes(const char* beginning, const SecsByReason& reasons, double all,
               std::vector<std::string>& notes) {
  for (const auto& [why, secs] : reasons) {
    notes.push_back(
        fmt::format("{} for {:.0f} % of the time: {}.", beginning, 100 * Share(secs, all), why));
  }
}

// "right_hip" to "left_ankle" with one reason are one sentence.
void NoteUnknown(const LoadTrial& trial, std::vector<std::string>& notes) {
  std::map<std::pair<std::string_view, double>, std::string> joints;
  for (std::size_t i = 0; i < urdf::kScoredJoints.size(); ++i) {
    for (const auto& [why, secs] : trial.why_unknown(i)) {
      std::string& list = joints[{why, secs}];
      list += (list.empty() ? "" : ", ") + std::string(ScoredLabel(i));
    }
  }
  for (const auto& [key, list] : joints) {
    notes.push_back(fmt::format("Load unknown for {:.0f} % of the time ({:.2f} s): {} ({}).",
                                100 * Share(key.second, trial.secs()), key.second, list,
                                key.first));
  }
}

void NoteCenterOfMass(const LoadTrial& trial, std::vector<std::string>& notes) {
  const Peak& off = trial.com_minus_mvn();
  if (off.count == 0) return;
  const double secs = trial.com_disagrees_secs();
  const std::string check =
      secs > 0 ? fmt::format("; more than 1 cm for {:.2f} s: check sex, segment lengths and frames",
                             secs)
               : "";
  notes.push_back(
      fmt::format("Centre of mass: {:.1f} mm from MVN's on average, {:.1f} mm at most{}.",
                  1e3 * off.mean(), 1e3 * off.most, check));
}

void NoteCompression(const LoadTrial& trial, std::vector<std::string>& notes) {
  const Peak& spine = trial.compression();
  if (spine.count == 0) return;
  notes.push_back(fmt::format(
      "L5/S1 compression: {:.0f} N on average, {:.0f} N at most (at {:.2f} s); above {:g} N for "
      "{:.2f} s, above {:g} N for {:.2f} s. Single-equivalent-muscle model, accuracy about 25 %.",
      spine.mean(), spine.most, trial.SecsOf(spine.at_nanos), kCompressionLimits[0],
      trial.compression_secs()[0], kCompressionLimits[1], trial.compression_secs()[1]));
}

bool IsStatic(const LoadTrial& trial, const loads::LoadSettings& settings) {
  if (!settings.motion.dynamic) return true;
  double static_secs = 0;
  for (const auto& [why, secs] : trial.why_static()) static_secs += secs;
  constexpr double kRounding = 1e-6;  // s, of sums
  return !trial.newest().forces.is_dynamic && static_secs >= trial.secs() - kRounding;
}

std::string MetricText(LoadMetric metric, const loads::Strength& strength) {
  return fmt::format("{} moment relative to the {} percentile of capacity{}", Name(metric),
                     Name(strength.percentile),
                     strength.factor == 1 ? "" : fmt::format(" x {:g}", strength.factor));
}

std::string StatureText(const PersonModel& model) {
  const urdf::Skeleton& skeleton = model.human.skeleton;
  std::string text = fmt::format("{:.2f} m", skeleton.height);
  if (!model.lengths_are_measured) return text;
  text += model.lengths_are_of_poses ? " (from the poses" : " (from the source";
  return text + (skeleton.ends_are_estimated ? "; ends of head, hands and feet estimated)" : ")");
}

std::string FloorText(const LoadTrial& trial, const TrialContext& context) {
  if (context.scene.floor_z) return "";
  const std::string_view why_not = trial.newest().forces.why_no_floor;
  return why_not.empty() ? " (found)" : fmt::format(" (lowest point of the feet: {})", why_not);
}

JointSummary JointOf(const LoadTrial& trial, std::size_t joint) {
  const loads::JointExposure exposure = trial.exposure().Of(joint);
  JointSummary summary;
  summary.samples = exposure.samples;
  summary.secs = exposure.secs;
  summary.above = exposure.above;
  summary.p10 = exposure.p10;
  summary.p50 = exposure.p50;
  summary.p90 = exposure.p90;
  if (std::isfinite(exposure.peak_ratio)) {
    summary.peak = {exposure.peak_ratio, trial.SecsOf(exposure.peak_stamp_nanos),
                    exposure.peak_channel, exposure.peak_moment, exposure.peak_capacity};
  }
  summary.why_unknown = trial.why_unknown(joint);
  return summary;
}

std::optional<ValueSummary> PeakSummary(const LoadTrial& trial, const Peak& peak) {
  if (peak.count == 0) return std::nullopt;
  return ValueSummary{peak.mean(), peak.most, trial.SecsOf(peak.at_nanos)};
}

constexpr std::size_t kMostNamed = 8;  // changes, in a text

double SecsAt(const LoadTrial& trial, const LoadTrial::Told& told) {
  return std::max(0.0, trial.SecsOf(told.stamp_nanos));
}

bool AreAll(const std::vector<LoadTrial::Told>& told, bool (*is)(const LoadTrial::Told&)) {
  return std::all_of(told.begin(), told.end(), is);
}

// "90 kg; from 12.50 s 75 kg (assumed)": one value, or what it was from when on.
template <class TextOf>
Fact FactOver(const LoadTrial& trial, const char* label, TextOf text_of,
              bool (*is_assumed)(const LoadTrial::Told&)) {
  const bool is_all_assumed = AreAll(trial.told(), is_assumed);
  std::string all, last;
  std::size_t named = 0;
  for (const LoadTrial::Told& told : trial.told()) {
    std::string text = text_of(told);
    if (is_assumed(told) && !is_all_assumed) text += " (assumed)";
    if (text == last) continue;
    if (++named > kMostNamed) return {label, all + "; and more", is_all_assumed};
    all += all.empty() ? text : fmt::format("; from {:.2f} s {}", SecsAt(trial, told), text);
    last = std::move(text);
  }
  return {label, std::move(all), is_all_assumed};
}

bool HandsAreUnknown(const LoadTrial::Told& told) { return !told.hands.is_known; }

Fact HandLoadFact(const LoadTrial& trial) {
  const auto [right_secs, left_secs] = trial.measured_hand_secs();
  const bool is_measured = right_secs + left_secs > 0;
  if (is_measured && AreAll(trial.told(), HandsAreUnknown))
    return {"hand load", "as measured", false};
  return FactOver(
      trial, "hand load", [](const auto& told) { return HandsText(told.hands); }, HandsAreUnknown);
}

}  // namespace

std::string TitleOf(const LoadTrial& trial) {
  const PersonState& person = trial.newest();
  return person.name.empty() ? fmt::format("Person {}", person.character)
                             : fmt::format("{} (person {})", person.name, person.character);
}

std::string ToldText(const LoadTrial& trial) {
  const auto& told = trial.told();
  if (told.size() < 2) return "";
  std::string text = "Body mass and hand load changed during the recording: ";
  for (std::size_t i = 0; i < told.size() && i < kMostNamed; ++i) {
    const urdf::BodyDescription& body = told[i].body;
    text += fmt::format(
        "{}from {:.2f} s {:g} kg{}, {}, {}", i == 0 ? "" : "; ", SecsAt(trial, told[i]),
        body.mass_kg, body.mass_is_assumed ? " (assumed)" : "", Name(body.sex),
        HandsAreUnknown(told[i]) ? "hand load unknown" : "holding " + HandsText(told[i].hands));
  }
  return text + (told.size() > kMostNamed ? "; and more." : ".");
}

std::vector<Fact> FactsOf(const LoadTrial& trial, const TrialContext& context) {
  const PersonModel& model = *trial.newest().model;
  const urdf::BodyDescription& body = model.description;
  const loads::LoadSettings& settings = context.scene.loads;
  std::vector<Fact> facts;
  facts.push_back(FactOver(
      trial, "sex", [](const auto& told) { return std::string(Name(told.body.sex)); },
      [](const auto& told) { return told.body.sex_is_assumed; }));
  facts.push_back(FactOver(
      trial, "mass", [](const auto& told) { return fmt::format("{:g} kg", told.body.mass_kg); },
      [](const auto& told) { return told.body.mass_is_assumed; }));
  facts.push_back({"stature", StatureText(model),
                   !model.lengths_are_measured && context.scene.height_is_assumed});
  if (!body.added_masses.empty()) {
    facts.push_back({"added mass", AddedMassText(body), false});
  }
  facts.push_back({"body table", urdf::Name(body.table), false});
  facts.push_back(HandLoadFact(trial));
  if (context.scene.wrenches) {
    facts.push_back({"measured", MeasuredText(trial, context.scene.wrenches->path), false});
  }
  facts.push_back(
      {"load metric", MetricText(trial.newest().forces.metric, settings.strength), false});
  facts.push_back({"load mode",
                   IsStatic(trial, settings)
                       ? "static"
                       : fmt::format("dynamic, accelerations below {:g} Hz, zero-phase",
                                     settings.motion.recording_cutoff_hz),
                   false});
  facts.push_back(
      {"floor", fmt::format("z = {:.3f} m{}", trial.floor_z(), FloorText(trial, context)), false});
  return facts;
}

std::vector<std::string> NotesOf(const LoadTrial& trial, const TrialContext& context) {
  std::vector<std::string> notes;
  const std::string changes = ChangesText(context.marks, trial.newest().name, context.people);
  if (!changes.empty()) notes.push_back(changes);
  if (std::string told = ToldText(trial); !told.empty()) notes.push_back(std::move(told));
  NoteAssumed(FactsOf(trial, context), notes);
  NoteTimes("Static (without accelerations)", trial.why_static(), trial.secs(), notes);
  if (trial.limited_secs() > 0) {
    const loads::LoadSettings& settings = context.scene.loads;
    notes.push_back(fmt::format(
        "Accelerations above {:g} m/s² or {:g} rad/s² were limited for {:.2f} s ({:.1f} %).",
        settings.most_acceleration, settings.motion.most_angular_acceleration, trial.limited_secs(),
        100 * Share(trial.limited_secs(), trial.secs())));
  }
  NoteTimes("Load metric differs from the requested one", trial.why_other_metric(), trial.secs(),
            notes);
  NoteUnknown(trial, notes);
  NoteCenterOfMass(trial, notes);
  NoteCompression(trial, notes);
  return notes;
}

TrialSummary SummaryOf(const LoadTrial& trial, const TrialContext& context) {
  const PersonState& person = trial.newest();
  TrialSummary summary;
  summary.source = context.source;
  summary.title = TitleOf(trial);
  summary.character = person.character;
  summary.name = person.name;
  summary.samples = trial.samples();
  summary.secs = trial.secs();
  summary.limits = context.scene.loads.meter.up;
  summary.mass_kg = person.model->description.mass_kg;
  summary.mass_with_added_kg = urdf::TotalMass(person.model->human.body);
  summary.height_m = person.model->human.skeleton.height;
  summary.facts = FactsOf(trial, context);
  for (std::size_t i = 0; i < summary.joints.size(); ++i) summary.joints[i] = JointOf(trial, i);
  summary.notes = NotesOf(trial, context);
  summary.com_minus_mvn_m = PeakSummary(trial, trial.com_minus_mvn());
  summary.compression = PeakSummary(trial, trial.compression());
  summary.shear = PeakSummary(trial, trial.shear());
  summary.compression_secs = trial.compression_secs();
  for (const TrialMark& mark : context.marks) {
    summary.marks.push_back({mark, LoadsAround(mark, trial)});
  }
  return summary;
}

}  // namespace kinescope::app
