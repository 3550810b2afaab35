#include "server/app/loads/load_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "server/app/loads/load_rows.h"
#include "server/loads/joint_score.h"

namespace kinescope::app {
namespace {

using nlohmann::json;

constexpr std::array<LoadClass, 4> kClasses = {LoadClass::kLow, LoadClass::kMedium,
                                               LoadClass::kHigh, LoadClass::kUnknown};

double SecsIn(const loads::JointExposure& exposure, LoadClass load_class) {
  return exposure.secs[static_cast<std::size_t>(load_class)];
}

// Shares of nothing are nothing.
double Share(double part, double all) { return all > 0 ? part / all : 0; }

json NumberOrNull(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

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

std::string WornText(const urdf::BodyDescription& body) {
  std::string text;
  for (const urdf::AddedMass& added : body.added_masses) {
    text += fmt::format("{}{:g} kg on {}", text.empty() ? "" : ", ", added.mass_kg,
                        urdf::kSegments[urdf::At(added.segment)].link_name);
  }
  return text;
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

}  // namespace

std::string TitleOf(const LoadTrial& trial) {
  const PersonState& person = trial.newest();
  return person.name.empty() ? fmt::format("Person {}", person.character)
                             : fmt::format("{} (person {})", person.name, person.character);
}

std::vector<Fact> FactsOf(const LoadTrial& trial, const TrialContext& context) {
  const PersonModel& model = *trial.newest().model;
  const urdf::BodyDescription& body = model.description;
  const loads::LoadSettings& settings = context.scene.loads;
  const BodyForces& forces = trial.newest().forces;
  std::vector<Fact> facts;
  facts.push_back({"sex", body.sex == urdf::Sex::kMale ? "male" : "female", body.sex_is_assumed});
  facts.push_back({"mass", fmt::format("{:g} kg", body.mass_kg), body.mass_is_assumed});
  facts.push_back({"stature",
                   fmt::format("{:.2f} m{}", model.human.skeleton.height,
                               model.lengths_are_measured ? " (from the source)" : ""),
                   !model.lengths_are_measured && context.scene.height_is_assumed});
  if (!body.added_masses.empty()) facts.push_back({"added mass", WornText(body), false});
  facts.push_back({"body table", urdf::Name(body.table), false});
  facts.push_back({"hand load", HandsText(settings.hands), !settings.hands.is_known});
  facts.push_back(
      {"load metric",
       fmt::format(
           "{} moment relative to the {} percentile of capacity{}", Name(forces.metric),
           Name(settings.strength.percentile),
           settings.strength.factor == 1 ? "" : fmt::format(" x {:g}", settings.strength.factor)),
       false});
  double static_secs = 0;
  for (const auto& [why, secs] : trial.why_static()) static_secs += secs;
  constexpr double kRounding = 1e-6;  // s, of sums
  const bool is_static =
      !settings.motion.dynamic || (!forces.is_dynamic && static_secs >= trial.secs() - kRounding);
  facts.push_back(
      {"load mode",
       is_static ? "static"
                 : fmt::format("dynamic, accelerations below {:g} Hz", settings.motion.cutoff_hz),
       false});
  return facts;
}

std::vector<std::string> NotesOf(const LoadTrial& trial, const TrialContext& context) {
  std::vector<std::string> notes;
  const double all = trial.secs();
  std::string assumed;
  for (const Fact& fact : FactsOf(trial, context)) {
    if (!fact.is_assumed) continue;
    assumed += fmt::format("{}{}: {}", assumed.empty() ? "" : "; ", fact.label, fact.value);
  }
  if (!assumed.empty()) {
    notes.push_back(fmt::format("Assumed (not specified): {}.", assumed));
  }
  for (const auto& [why, secs] : trial.why_static()) {
    notes.push_back(fmt::format("Static (without accelerations) for {:.0f} % of the time: {}.",
                                100 * Share(secs, all), why));
  }
  for (const auto& [why, secs] : trial.why_other_metric()) {
    notes.push_back(
        fmt::format("Load metric differs from the requested one for {:.0f} % of the time: {}.",
                    100 * Share(secs, all), why));
  }
  NoteUnknown(trial, notes);
  if (const Peak& off = trial.com_minus_mvn(); off.count > 0) {
    notes.push_back(fmt::format(
        "Centre of mass: {:.1f} mm from MVN's on average, {:.1f} mm at most{}.", 1e3 * off.mean(),
        1e3 * off.most,
        trial.com_disagrees_secs() > 0
            ? fmt::format("; more than 1 cm for {:.2f} s: check sex, segment lengths and frames",
                          trial.com_disagrees_secs())
            : ""));
  }
  if (const Peak& spine = trial.compression(); spine.count > 0) {
    notes.push_back(fmt::format(
        "L5/S1 compression: {:.0f} N on average, {:.0f} N at most (at {:.2f} s); above {:g} N for "
        "{:.2f} s, above {:g} N for {:.2f} s. Single-equivalent-muscle model, accuracy about 25 %.",
        spine.mean(), spine.most, trial.SecsOf(spine.at_nanos), loads::kCompressionLimits[0],
        trial.compression_secs()[0], loads::kCompressionLimits[1], trial.compression_secs()[1]));
  }
  return notes;
}

std::string SummaryText(const LoadTrial& trial, const TrialContext& context) {
  std::string text = fmt::format("{}, {}: {} samples, {:.2f} s\n", context.source, TitleOf(trial),
                                 trial.samples(), trial.secs());
  for (const Fact& fact : FactsOf(trial, context)) {
    text +=
        fmt::format("  {:<14} {}{}\n", fact.label, fact.value, fact.is_assumed ? " (assumed)" : "");
  }
  text += fmt::format("\n{:<15}{:>7}{:>8}{:>7}{:>9}{:>8}{:>6}{:>6}{:>7}{:>9}  {}\n", "joint", "low",
                      "medium", "high", "unknown", "p10", "p50", "p90", "peak", "at", "direction");
  for (std::size_t i = 0; i < urdf::kScoredJoints.size(); ++i) {
    const loads::JointExposure exposure = trial.exposure().Of(i);
    const auto percent = [&](LoadClass load_class) {
      return fmt::format("{:.0f} %", 100 * Share(SecsIn(exposure, load_class), trial.secs()));
    };
    const auto ratio = [](double value) {
      return std::isfinite(value) ? fmt::format("{:.2f}", value) : std::string("-");
    };
    const bool has_peak = std::isfinite(exposure.peak_ratio);
    text += fmt::format(
        "{:<15}{:>7}{:>8}{:>7}{:>9}{:>8}{:>6}{:>6}{:>7}{:>9}  {}\n", ScoredLabel(i),
        percent(LoadClass::kLow), percent(LoadClass::kMedium), percent(LoadClass::kHigh),
        percent(LoadClass::kUnknown), ratio(exposure.p10), ratio(exposure.p50), ratio(exposure.p90),
        ratio(exposure.peak_ratio),
        has_peak ? fmt::format("{:.2f} s", trial.SecsOf(exposure.peak_stamp_nanos)) : "-",
        has_peak
            ? fmt::format("{}{}", exposure.peak_channel,
                          std::isfinite(exposure.peak_moment)
                              ? fmt::format(" {:.1f} of {:.1f} N·m", std::abs(exposure.peak_moment),
                                            exposure.peak_capacity)
                              : "")
            : "");
  }
  const std::vector<std::string> notes = NotesOf(trial, context);
  if (!notes.empty()) text += '\n';
  for (const std::string& note : notes) text += note + '\n';
  return text;
}

json SummaryJson(const LoadTrial& trial, const TrialContext& context) {
  const PersonState& person = trial.newest();
  const urdf::BodyDescription& body = person.model->description;
  json facts = json::array(), exposure = json::array();
  for (const Fact& fact : FactsOf(trial, context)) {
    facts.push_back({{"name", fact.label}, {"value", fact.value}, {"is_assumed", fact.is_assumed}});
  }
  for (std::size_t i = 0; i < urdf::kScoredJoints.size(); ++i) {
    const loads::JointExposure of = trial.exposure().Of(i);
    json secs = json::object(), why = json::object();
    for (const LoadClass load_class : kClasses) {
      secs[kinescope::Name(load_class)] = SecsIn(of, load_class);
    }
    for (const auto& [reason, reason_secs] : trial.why_unknown(i)) {
      why[std::string(reason)] = reason_secs;
    }
    const bool has_peak = std::isfinite(of.peak_ratio);
    exposure.push_back(
        {{"joint", ScoredName(i)},
         {"seconds", secs},
         {"p10", NumberOrNull(of.p10)},
         {"p50", NumberOrNull(of.p50)},
         {"p90", NumberOrNull(of.p90)},
         {"peak_ratio", NumberOrNull(of.peak_ratio)},
         {"peak_time_s", has_peak ? json(trial.SecsOf(of.peak_stamp_nanos)) : json(nullptr)},
         {"peak_channel", has_peak ? json(of.peak_channel) : json(nullptr)},
         {"peak_moment_Nm", has_peak ? NumberOrNull(of.peak_moment) : json(nullptr)},
         {"peak_capacity_Nm", has_peak ? NumberOrNull(of.peak_capacity) : json(nullptr)},
         {"unknown", why}});
  }
  const auto peak = [&](const Peak& of) {
    return of.count == 0 ? json(nullptr)
                         : json{{"mean", of.mean()},
                                {"most", of.most},
                                {"most_at_s", trial.SecsOf(of.at_nanos)}};
  };
  return {{"person", person.character},
          {"name", person.name},
          {"samples", trial.samples()},
          {"seconds", trial.secs()},
          {"mass_kg", body.mass_kg},
          {"mass_with_extra_kg", urdf::TotalMass(person.model->human.body)},
          {"height_m", person.model->human.skeleton.height},
          {"facts", facts},
          {"notes", NotesOf(trial, context)},
          {"exposure", exposure},
          {"com_minus_mvn_m", peak(trial.com_minus_mvn())},
          {"l5_s1_compression_N", peak(trial.compression())},
          {"l5_s1_shear_N", peak(trial.shear())}};
}

}  // namespace kinescope::app
