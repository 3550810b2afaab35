/// What a trial amounts to, in words and as JSON: who, with which assumptions, exposure of each
/// joint, what could not be said and why. Pure functions; any thread.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "server/app/loads/load_trial.h"
#include "server/scene/scene_builder.h"
#include "server/scene/scene_options.h"

namespace kinescope::app {

/// What is the same for all people of a recording.
struct TrialContext {
  std::string source;  // its file name, or "demo:lift"
  double rate_hz = 0;  // 0: not known
  SceneOptions scene;
  nlohmann::json options;  // by name, as the run took them
};

/// A pair of label and value for people; `is_assumed`: nobody said it.
struct Fact {
  std::string label, value;
  bool is_assumed = false;
};

/// Sex, mass, height, body table, extra masses, hands, metric, strength, accelerations.
std::vector<Fact> FactsOf(const LoadTrial& trial, const TrialContext& context);

/// Sentences about what was assumed, could not be known or is not as asked for, with its share of
/// the time; empty when there is nothing to say.
std::vector<std::string> NotesOf(const LoadTrial& trial, const TrialContext& context);

/// "Person 0", with the name where there is one.
std::string TitleOf(const LoadTrial& trial);

/// Several lines: title, facts, exposure, notes.
std::string SummaryText(const LoadTrial& trial, const TrialContext& context);

/// Of one person, as docs/loads.md describes it.
nlohmann::json SummaryJson(const LoadTrial& trial, const TrialContext& context);

}  // namespace kinescope::app
