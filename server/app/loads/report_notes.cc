#include "server/app/loads/report_notes.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "core/compression_limits.h"
#include "server/app/loads/report_finding.h"
#include "server/app/loads/report_text.h"
#include "server/loads/joint_score.h"

namespace kinescope::app {
namespace {

const char* ReferenceOf(urdf::BodyTable table) {
  switch (table) {
    case urdf::BodyTable::kDeLeva: return "de Leva 1996";
    case urdf::BodyTable::kWinter: return "Winter 2009";
    case urdf::BodyTable::kDumas: return "Dumas et al. 2007";
    case urdf::BodyTable::kIit: return "IIT";
  }
  return "";
}

const char* OrdinalOf(loads::Percentile percentile) {
  switch (percentile) {
    case loads::Percentile::k5: return "5th";
    case loads::Percentile::k50: return "50th";
    case loads::Percentile::k95: return "95th";
  }
  return "";
}

// A population stands for the person until a factor or another percentile was chosen.
Fact StrengthFact(const loads::Strength& strength, const std::vector<LoadTrial::Told>& told) {
  const auto is_male = [](const LoadTrial::Told& each) {
    return each.body.sex == urdf::Sex::kMale;
  };
  const bool has_men = std::any_of(told.begin(), told.end(), is_male);
  const bool has_women = !std::all_of(told.begin(), told.end(), is_male);
  std::string value =
      fmt::format("{} percentile of {}{}{}", OrdinalOf(strength.percentile), has_men ? "men" : "",
                  has_men && has_women ? " and of " : "", has_women ? "women" : "");
  if (strength.factor != 1) value += fmt::format(" × {:g}", strength.factor);
  return {"strength", std::move(value),
          strength.factor == 1 && strength.percentile == loads::Percentile::k50};
}

std::string FloorText(const LoadTrial& trial, bool is_given) {
  std::uint64_t down = 0, known = 0;
  for (const TrialSample& sample : trial.curves()) {
    if (!sample.is_ground_known) continue;
    ++known;
    if (sample.foot_on_floor[0] || sample.foot_on_floor[1]) ++down;
  }
  const std::string height =
      fmt::format("{} {}{:.2f} m",
                  is_given ? "given, z =" : "found at z =", trial.floor_z() < -0.005 ? "−" : "",
                  std::abs(trial.floor_z()));
  const std::string_view why_not = trial.newest().forces.why_no_floor;
  if (!why_not.empty()) return fmt::format("not found: {}", why_not);
  if (known == 0) return height + ", no foot contact known";
  return fmt::format("{}, a foot on it {} %", height, PercentText(down, trial.samples()));
}

std::string RatioText(LoadMetric metric) {
  switch (metric) {
    case LoadMetric::kTotal: return "moment ÷ strength";
    case LoadMetric::kOverload: return "moment added by the loads ÷ strength";
    case LoadMetric::kNorm: return "|moment| ÷ strength of the weaker direction";
    case LoadMetric::kExternal: return "of another program";
  }
  return "";
}

bool HoldsAtGrip(const HandLoad& hands) {
  bool holds = hands.both_kg > 0 && !hands.both_com_in_world;
  for (std::size_t side = 0; side < hands.mass_kg.size(); ++side) {
    holds = holds || (hands.mass_kg[side] > 0 && !hands.com_in_hand[side]);
  }
  return holds;
}

// Shares of the trial's time.
std::string TimeShare(double secs, double all) {
  if (all <= 0) return "the whole trial";
  const double percent = 100 * secs / all;
  if (percent >= 99.95) return "the whole trial";
  return fmt::format("{} ({:.2f} s)", percent < 0.05 ? "<0.1 %" : fmt::format("{:.1f} %", percent),
                     secs);
}

void NoteReasons(const char* beginning, const SecsByReason& reasons, double all,
                 std::vector<std::string>& notes) {
  for (const auto& [why, secs] : reasons) {
    notes.push_back(fmt::format("{} for {}: {}.", beginning, TimeShare(secs, all), why));
  }
}

void NoteUnknownJoints(const LoadTrial& trial, std::vector<std::string>& notes) {
  std::map<std::pair<std::string_view, double>, std::vector<std::size_t>> joints;
  for (std::size_t i = 0; i < urdf::kScoredJointCount; ++i) {
    for (const auto& [why, secs] : trial.why_unknown(i)) joints[{why, secs}].push_back(i);
  }
  for (const auto& [key, list] : joints) {
    const std::string who =
        list.size() == urdf::kScoredJointCount ? "all joints" : JointWords(list);
    notes.push_back(fmt::format("Unknown for {}: {} – {}.", TimeShare(key.second, trial.secs()),
                                who, key.first));
  }
}

void NoteCheckOfCom(const LoadTrial& trial, std::vector<std::string>& notes) {
  constexpr double kMillis = 1e3;
  const Peak& off = trial.com_minus_mvn();
  if (off.count == 0) {
    notes.emplace_back("Centre of mass: not compared, because the source has none of its own.");
    return;
  }
  std::string note =
      fmt::format("Centre of mass: {:.1f} mm from MVN's on average, at most {:.1f} mm",
                  kMillis * off.mean(), kMillis * off.most);
  if (trial.com_disagrees_secs() > 0) {
    note += fmt::format("; more than 1 cm for {}: check sex, segment lengths and frames",
                        TimeShare(trial.com_disagrees_secs(), trial.secs()));
  }
  notes.push_back(note + ".");
}

bool IsAlwaysStatic(const LoadTrial& trial) {
  constexpr double kRounding = 1e-6;  // s, of sums
  double secs = 0;
  for (const auto& [why, part] : trial.why_static()) secs += part;
  return !trial.newest().forces.is_dynamic && secs >= trial.secs() - kRounding;
}

}  // namespace

std::vector<Fact> HeadFactsOf(const LoadTrial& trial, const TrialContext& context) {
  std::vector<Fact> facts;
  const loads::LoadSettings& settings = context.scene.loads;
  for (Fact& fact : FactsOf(trial, context)) {
    if (fact.label == "body table" || fact.label == "load mode" || fact.label == "load metric" ||
        fact.label == "floor") {
      continue;  // the method tells them, or the facts below
    }
    if (fact.label == "mass") fact.label = "body mass";
    if (fact.label == "hand load") {
      if (fact.is_assumed) fact.value = "unknown, computed as empty";
    }
    facts.push_back(std::move(fact));
  }
  const bool holds_at_grip =
      std::any_of(trial.told().begin(), trial.told().end(),
                  [](const LoadTrial::Told& told) { return HoldsAtGrip(told.hands); });
  if (holds_at_grip) facts.push_back({"held", "at the grip", true});
  facts.push_back(StrengthFact(settings.strength, trial.told()));
  facts.push_back({"floor", FloorText(trial, context.scene.floor_z.has_value()), false});
  facts.push_back({"ratio",
                   fmt::format("{}, {}", RatioText(trial.newest().forces.metric),
                               trial.newest().forces.is_dynamic ? "with accelerations" : "static"),
                   false});
  return facts;
}

std::string MethodText(const LoadTrial& trial, const TrialContext& context) {
  const loads::LoadSettings& settings = context.scene.loads;
  const PersonState& person = trial.newest();
  const auto& up = settings.meter.up;
  std::string text = fmt::format(
      "Inverse dynamics (Newton–Euler) from hands, head and feet to the pelvis; segment masses: "
      "{}. ",
      ReferenceOf(person.model->description.table));
  if (!settings.motion.dynamic || IsAlwaysStatic(trial)) {
    text += "Static: without accelerations. ";
  } else {
    text += fmt::format("Accelerations of the suit, low-pass {:g} Hz, {}. ",
                        settings.motion.recording_cutoff_hz,
                        trial.causal_secs() > 0 ? "zero-phase where possible" : "zero-phase");
  }
  text += person.forces.ground_is_measured
              ? "Ground reaction force measured. "
              : fmt::format(
                    "Ground reaction force computed from the motion, shared by the feet "
                    "according to the centre of pressure; foot contact {}. ",
                    person.sample.foot_contacts ? "from the recording" : "detected");
  text +=
      "Static strength by anatomical direction (Stobbe in Chaffin et al.; Delp; Vasavada); the "
      "largest ratio counts. L5/S1: one equivalent extensor at 6 cm; ";
  if (settings.compression_counts) {
    text += fmt::format(
        "the larger ratio of moment and compression counts; {:g} N is {:g}, {:g} N is {:g} "
        "(NIOSH 1981).",
        kCompressionLimits[0], up[0], kCompressionLimits[1], up[1]);
  } else {
    text +=
        fmt::format("its ratio is that of the moment alone; limits {:g} and {:g} N (NIOSH 1981).",
                    kCompressionLimits[0], kCompressionLimits[1]);
  }
  return text;
}

std::vector<std::string> TrustNotesOf(const LoadTrial& trial, const TrialContext& context) {
  std::vector<std::string> notes;
  const std::string changes = ChangesText(context.marks, trial.newest().name, context.people);
  if (!changes.empty()) notes.push_back(changes);
  if (std::string told = ToldText(trial); !told.empty()) notes.push_back(std::move(told));
  const double all = trial.secs();
  NoteUnknownJoints(trial, notes);
  NoteReasons("Without accelerations", trial.why_static(), all, notes);
  NoteReasons("Another ratio than requested", trial.why_other_metric(), all, notes);
  if (trial.causal_secs() > 0) {
    constexpr double kMillis = 1e3;
    notes.push_back(fmt::format("Filtered with lag for {}: up to {:.0f} ms late.",
                                TimeShare(trial.causal_secs(), all),
                                kMillis * trial.most_delay_secs()));
  }
  if (trial.limited_secs() > 0) {
    notes.push_back(fmt::format("Implausible accelerations were limited for {}.",
                                TimeShare(trial.limited_secs(), all)));
  }
  NoteCheckOfCom(trial, notes);
  notes.push_back(
      fmt::format("Compression is accurate to ±{:g} %. Net moments do not contain co-contraction.",
                  100 * kCompressionUncertainty));
  if (!trial.newest().forces.ground_is_measured) {
    notes.emplace_back(
        "Legs: the split between the feet is an estimate. Only contact with the floor is "
        "considered.");
  }
  notes.push_back(
      fmt::format("{:.2f} s of one trial are no verdict on a working day.", trial.secs()));
  return notes;
}

}  // namespace kinescope::app
