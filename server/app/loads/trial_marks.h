/// What was marked during a trial, and the loads around it. Pure functions; any thread.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene_state.h"
#include "server/app/loads/load_trial.h"
#include "server/marks/mark_track.h"

namespace kinescope::app {

/// Times in s since the beginning of the recording.
struct TrialMark {
  double from_secs = 0;
  double to_secs = 0;  // of a moment: from_secs
  bool is_span = false;
  bool is_change = false;  // what an operator changed, not what a person saw
  int button = 0;          // 0: free text
  std::string text, role;
};

/// Those of `track` between two states of a recording, in the order of time.
std::vector<TrialMark> MarksOf(const marks::MarkTrack& track, const SceneState& first,
                               const SceneState& last);

/// What was changed during the trial of the person called `name`, in one sentence: loads are
/// computed with what held when it was begun. "" if nothing was, or only how it looked, or of
/// others in the recording, whose names are among those of all `people`.
std::string ChangesText(const std::vector<TrialMark>& marks, const std::string& name,
                        const std::set<std::string>& people);

/// The loads of one person around a mark: of a moment within marks::kWindowNanos before and after
/// it, of a span within the span.
struct MarkLoads {
  double from_secs = 0, to_secs = 0;  // where they are looked for
  struct Highest {
    std::size_t joint = 0;  // index into kScoredJoints
    double ratio = 0;
    LoadClass band = LoadClass::kUnknown;
    double at_secs = 0;
  };
  std::optional<Highest> highest;       // absent: no load is known
  std::optional<double> compression_N;  // the highest at L5/S1
};

/// @pre `trial` keeps its curves
MarkLoads LoadsAround(const TrialMark& mark, const LoadTrial& trial);

/// "3.20 s", "3.20 to 5.10 s".
std::string TimesText(const TrialMark& mark);

/// "0.82 right knee, 3120 N", or "no load known".
std::string LoadsText(const MarkLoads& loads);

}  // namespace kinescope::app
