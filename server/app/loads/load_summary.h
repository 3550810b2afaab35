/// Summarises a trial as text and as JSON: person, assumptions, exposure of each joint, unknown
/// loads and the reasons. Pure functions; any thread.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "server/app/loads/load_trial.h"
#include "server/scene/scene_builder.h"
#include "server/scene/scene_options.h"

namespace kinescope::app {

/// Data that are the same for all people of a recording.
struct TrialContext {
  std::string source;  // its file name, or "demo:lift"
  double rate_hz = 0;  // 0: unknown
  SceneOptions scene;
  nlohmann::json options;  // option values of this run, by name
};

/// A label and its value for display; `is_assumed`: a default value.
struct Fact {
  std::string label, value;
  bool is_assumed = false;
};

/// Sex, mass, height, body table, added masses, hand loads, metric, capacity, inertial forces.
std::vector<Fact> FactsOf(const LoadTrial& trial, const TrialContext& context);

/// Sentences about assumptions, unknown loads and deviations from the options, each with its share
/// of the time; empty if there are none.
std::vector<std::string> NotesOf(const LoadTrial& trial, const TrialContext& context);

/// "Person 0", with the name if there is one.
std::string TitleOf(const LoadTrial& trial);

/// Several lines: title, facts, exposure, notes.
std::string SummaryText(const LoadTrial& trial, const TrialContext& context);

/// For one person, as described in docs/loads.md.
nlohmann::json SummaryJson(const LoadTrial& trial, const TrialContext& context);

}  // namespace kinescope::app
