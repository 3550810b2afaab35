/// Splits the time of a trial into intervals of equal state, for plots. Pure function; any thread.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "server/app/loads/load_trial.h"
#include "server/loads/gap.h"

namespace kinescope::app {

template <class State>
struct TrialInterval {
  double from = 0, to = 0;  // s
  State state = {};
};

/// `state_of(sample)`: a State. A sample lasts until the next one, before a gap half a second; the
/// gap has the state `unknown`. @pre `trial` keeps its curves
template <class State, class StateOf>
std::vector<TrialInterval<State>> IntervalsOf(const LoadTrial& trial, State unknown,
                                              StateOf&& state_of) {
  std::vector<TrialInterval<State>> intervals;
  const auto add = [&](double from, double to, State state) {
    if (!intervals.empty() && intervals.back().state == state) {
      intervals.back().to = to;
    } else {
      intervals.push_back({from, to, state});
    }
  };
  const std::vector<TrialSample>& samples = trial.curves();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double from = trial.SecsOf(samples[i].stamp_nanos);
    const double next = i + 1 < samples.size() ? trial.SecsOf(samples[i + 1].stamp_nanos) : from;
    if (next < from) continue;
    const double to = std::min(next, from + loads::kLongestGapSecs);
    add(from, to, state_of(samples[i]));
    if (to < next) add(to, next, unknown);
  }
  return intervals;
}

}  // namespace kinescope::app
