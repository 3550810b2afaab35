/// Summarises a trial as values: person, assumptions, exposure of each joint, unknown loads and the
/// reasons. load_summary_print.cc prints them as text and as JSON. Pure functions; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "server/app/loads/load_trial.h"
#include "server/app/loads/trial_marks.h"
#include "server/scene/scene_builder.h"
#include "server/scene/scene_options.h"

namespace kinescope::app {

/// Data that are the same for all people of a recording.
struct TrialContext {
  std::string source;  // its file name, or "demo:lift", "pose:right_elbow=90"
  double rate_hz = 0;  // 0: unknown
  SceneOptions scene;
  nlohmann::json options;  // option values of this run, by name
  std::vector<TrialMark> marks;
  std::set<std::string> people;  // names of all people in the recording
};

/// A label and its value for display; `is_assumed`: a default value.
struct Fact {
  std::string label, value;
  bool is_assumed = false;
};

/// "Body mass and hand load changed during the recording: from 0.00 s 90 kg …"; "": they did not.
std::string ToldText(const LoadTrial& trial);

/// Sex, mass, height, body table, added masses, hand loads, metric, capacity, inertial forces.
std::vector<Fact> FactsOf(const LoadTrial& trial, const TrialContext& context);

/// Sentences about assumptions, unknown loads and deviations from the options, each with its share
/// of the time; empty if there are none.
std::vector<std::string> NotesOf(const LoadTrial& trial, const TrialContext& context);

/// "Person 0", with the name if there is one.
std::string TitleOf(const LoadTrial& trial);

/// Exposure of one joint.
struct JointSummary {
  struct PeakRatio {
    double ratio = 0;
    double at_secs = 0;  // since the beginning of the recording
    std::string_view channel;
    double moment = 0, capacity = 0;  // N·m; NaN: unknown
  };
  std::array<std::uint64_t, kLoadClassCount> samples{};  // by band
  std::array<double, kLoadClassCount> secs{};            // by band
  double p10 = 0, p50 = 0, p90 = 0;                      // of the ratio; NaN: always unknown
  std::array<loads::AboveLimit, 2> above;                // by class limit
  std::optional<PeakRatio> peak;                         // absent: always unknown
  SecsByReason why_unknown;
};

/// Mean and maximum of a value over the trial.
struct ValueSummary {
  double mean = 0, most = 0;
  double most_at_secs = 0;  // since the beginning of the recording
};

/// All that is printed about one person.
struct TrialSummary {
  std::string source, title;
  int character = 0;
  std::string name;  // "": unknown
  std::uint64_t samples = 0;
  double secs = 0;
  std::array<double, 2> limits{};  // of the classes
  double mass_kg = 0, mass_with_added_kg = 0, height_m = 0;
  std::vector<Fact> facts;
  std::array<JointSummary, urdf::kScoredJointCount> joints;  // in the order of kScoredJoints
  std::vector<std::string> notes;
  std::optional<ValueSummary> com_minus_mvn_m, compression, shear;  // N, at L5/S1
  std::array<double, 2> compression_secs{};  // above each of kCompressionLimits
  struct MarkSummary {
    TrialMark mark;
    MarkLoads loads;
  };
  std::vector<MarkSummary> marks;
};

TrialSummary SummaryOf(const LoadTrial& trial, const TrialContext& context);

/// Several lines: title, facts, exposure, notes.
std::string SummaryText(const TrialSummary& summary);

/// As described in docs/loads.md.
nlohmann::json SummaryJson(const TrialSummary& summary);

}  // namespace kinescope::app
