#include "server/app/loads/trial_marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "core/system/clocks.h"
#include "core/system/starts_with.h"
#include "core/system/words.h"
#include "server/table/load_rows.h"

namespace kinescope::app {
namespace {

// As server/app/serve/control_desk.cc writes what has been changed: not a camera, a name, a
// recording.
bool ChangesLoads(const std::string& text) {
  constexpr std::string_view kOfLoads[] = {"hand load of ", "mass of ", "sex of ", "stature of ",
                                           "class limits: "};
  return std::any_of(std::begin(kOfLoads), std::end(kOfLoads),
                     [&](std::string_view begin) { return StartsWith(text, begin); });
}

// "mass of Ben: 80 kg → 95 kg" in a recording of Ann and Ben, of Ann.
bool IsOfAnother(const std::string& text, const std::string& name,
                 const std::set<std::string>& people) {
  const std::string lower = Lower(text);  // a bag has the names of models: "ben"
  const auto is_of = [&](const std::string& other) {
    return lower.find(" of " + Lower(other) + ": ") != std::string::npos;
  };
  return !is_of(name) && std::any_of(people.begin(), people.end(), is_of);
}

}  // namespace

std::vector<TrialMark> MarksOf(const marks::MarkTrack& track, const SceneState& first,
                               const SceneState& last) {
  std::vector<TrialMark> found;
  for (const marks::TrackMark* const each : track.Between(first, last)) {
    const marks::Mark& mark = each->mark;
    found.push_back({track.SecsAfter(first, each->from_nanos),
                     track.SecsAfter(first, each->to_nanos), each->is_span(),
                     mark.kind == marks::Kind::kChange, mark.button, mark.text, mark.role});
  }
  return found;
}

std::string ChangesText(const std::vector<TrialMark>& marks, const std::string& name,
                        const std::set<std::string>& people) {
  constexpr std::size_t kMost = 4;
  std::string changes;
  std::size_t count = 0;
  for (const TrialMark& mark : marks) {
    if (!mark.is_change || !ChangesLoads(mark.text)) continue;
    if (IsOfAnother(mark.text, name, people)) continue;
    if (++count > kMost) continue;
    changes += fmt::format("{}{} at {}", count == 1 ? "" : ", ", mark.text, TimesText(mark));
  }
  if (count == 0) return "";
  if (count > kMost) changes += fmt::format(" and {} more", count - kMost);
  return "Computed with what held at the beginning, although this was changed: " + changes + ".";
}

MarkLoads LoadsAround(const TrialMark& mark, const LoadTrial& trial) {
  const double window = mark.is_span ? 0 : Secs(marks::kWindowNanos);
  MarkLoads found;
  found.from_secs = mark.from_secs - window;
  found.to_secs = mark.to_secs + window;
  const std::vector<TrialSample>& samples = trial.curves();
  auto at = std::partition_point(samples.begin(), samples.end(), [&](const TrialSample& sample) {
    return trial.SecsOf(sample.stamp_nanos) < found.from_secs;
  });
  for (; at != samples.end(); ++at) {
    const TrialSample& sample = *at;
    const double secs = trial.SecsOf(sample.stamp_nanos);
    if (secs > found.to_secs) break;
    for (std::size_t joint = 0; joint < sample.joints.size(); ++joint) {
      const TrialSample::Joint& load = sample.joints[joint];
      const bool is_higher = !found.highest || load.ratio > found.highest->ratio;
      if (load.band == LoadClass::kUnknown || !is_higher) continue;
      found.highest = {joint, load.ratio, load.band, secs};
    }
    if (std::isfinite(sample.compression)) {
      found.compression_N =
          std::max(found.compression_N.value_or(sample.compression), double{sample.compression});
    }
  }
  return found;
}

std::string TimesText(const TrialMark& mark) {
  return mark.is_span ? fmt::format("{:.2f} to {:.2f} s", mark.from_secs, mark.to_secs)
                      : fmt::format("{:.2f} s", mark.from_secs);
}

std::string LoadsText(const MarkLoads& loads) {
  if (!loads.highest) return "no load known";
  std::string text =
      fmt::format("{:.2f} {}", loads.highest->ratio, ScoredLabel(loads.highest->joint));
  if (loads.compression_N) text += fmt::format(", {:.0f} N", *loads.compression_N);
  return text;
}

}  // namespace kinescope::app
