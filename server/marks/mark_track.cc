#include "server/marks/mark_track.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <utility>

#include "core/system/clocks.h"

namespace kinescope::marks {
namespace {

constexpr std::int64_t kClocksDiffer = 600 * kNanosPerSecond;  // of two machines, at most

// The time code begins again each day, that of a simulated suit with each stream. `nanos_after`: of
// the moment after the state, by the clock of the track.
bool IsOfThatDay(const SceneState& state, const Moment& moment, std::int64_t nanos_after) {
  const bool knows_day = !state.people.empty() && state.people.front().sample.has_time_of_day &&
                         moment.stamp_nanos > 0;
  return !knows_day ||
         std::abs(state.stamp_nanos + nanos_after - moment.stamp_nanos) < kClocksDiffer;
}

}  // namespace

template <class At>
std::int64_t MarkTrack::NanosOf(const At& at) const {
  switch (clock_) {
    case TrackClock::kServer: return at.made_nanos;
    case TrackClock::kTimeCode: return kNanosPerMilli * at.time_code_millis;
    case TrackClock::kStamp: return at.stamp_nanos;
  }
  return 0;
}

MarkTrack::MarkTrack(const std::vector<Mark>& marks, TrackClock clock) : clock_(clock) {
  std::map<std::uint64_t, const Mark*> newest;  // by id
  for (const Mark& mark : marks) newest[mark.id] = &mark;
  for (const auto& [id, mark] : newest) {
    if (mark->is_removed || mark->kind == Kind::kTrial) continue;
    TrackMark shown = {NanosOf(mark->at), 0, *mark};
    shown.to_nanos = mark->end ? std::max(NanosOf(*mark->end), shown.from_nanos) : shown.from_nanos;
    marks_.push_back(std::move(shown));
  }
  std::stable_sort(marks_.begin(), marks_.end(), [](const TrackMark& a, const TrackMark& b) {
    return a.from_nanos < b.from_nanos;
  });
}

std::vector<const TrackMark*> MarkTrack::At(const SceneState& state) const {
  const std::int64_t now = NanosOf(state);
  std::vector<const TrackMark*> found;
  for (const TrackMark& each : marks_) {
    if (each.from_nanos > now) break;
    const std::int64_t end = each.is_span() ? each.to_nanos : each.from_nanos + kWindowNanos;
    const bool lasts = now <= end && IsOfThatDay(state, each.mark.at, each.from_nanos - now);
    if (lasts) found.push_back(&each);
  }
  return found;
}

std::vector<const TrackMark*> MarkTrack::Between(const SceneState& first,
                                                 const SceneState& last) const {
  const std::int64_t from = NanosOf(first), to = NanosOf(last);
  std::vector<const TrackMark*> found;
  for (const TrackMark& each : marks_) {
    const bool is_within = each.to_nanos >= from && each.from_nanos <= to;
    const bool is_of_it = is_within && IsOfThatDay(first, each.mark.at, each.from_nanos - from);
    if (is_of_it) found.push_back(&each);
  }
  return found;
}

double MarkTrack::SecsAfter(const SceneState& state, std::int64_t nanos) const {
  return Secs(nanos - NanosOf(state));
}

}  // namespace kinescope::marks
