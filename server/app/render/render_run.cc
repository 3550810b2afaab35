#include "server/app/render/render_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "core/system/stop_signal.h"
#include "server/app/marks_option.h"
#include "server/app/progress.h"
#include "server/app/render/moments.h"
#include "server/app/render/render_tasks.h"
#include "server/app/render/resume_check.h"
#include "server/picture/moving_robots.h"
#include "server/scene/scene_reader.h"
#include "server/source/open_source.h"
#include "server/source/scheme.h"

namespace kinescope::app {
namespace {

SceneOptions PeopleOf(const RenderOptions& options) {
  SceneOptions people = ToShownSceneOptions(options.person, options.loads);
  AddBagView(options.view, people);
  return people;
}

// Reads the source once and hands its scenes to the tasks that need them.
class RenderRun {
 public:
  RenderRun(const RenderOptions& options, const SourcePlan& plan, const RunSettings& settings,
            DrawPool& pool)
      : options_(options),
        plan_(plan),
        settings_(settings),
        pool_(pool),
        people_(PeopleOf(options)),
        reader_(plan.source, people_),
        grid_(ToTimeGrid(options.clip, IsSubjectUrl(plan.source))),
        provenance_(options, plan.source, pool.info()),
        check_(provenance_, settings),
        additions_(options.view, options.backend, people_),
        track_(ReadTrack(options.marks, IsOfRos(plan.source))) {
    CheckMoments();
    for (const Output& output : plan.outputs) AddOutput(output);
    Prescan();
  }

  std::vector<OutputResult> Run() {
    if (HasStills() || HasClips()) {
      progress_.emplace("pictures:", static_cast<int>(CountPictures()));
      reading_.emplace("seconds read:", static_cast<int>(SecsBeforePictures()), /*quiet_secs=*/1);
      if (HasMoments()) {
        RenderMoments();
      } else {
        if (HasClips() || (HasStills() && options_.moment.time)) RenderAtTimes();
        if (HasStills() && !options_.moment.time) ReadUpToStill();
      }
      for (OutputWriter& writer : writers_) writer.Finish(clip_pictures_);
    }
    std::vector<OutputResult> results;
    for (const OutputWriter& writer : writers_) {
      results.push_back(writer.result());
      results.back().took_secs = progress_ ? progress_->secs() : 0;
    }
    return results;
  }

 private:
  void CheckMoments() const {
    const auto check = [this](const char* option, double given, double secs) {
      CheckReach(fmt::format("--{}={}", option, given), secs, plan_.source);
    };
    const MomentOptions& still = options_.moment;
    const ClipOptions& clip = options_.clip;
    if (still.sample) {
      const auto sample = static_cast<double>(*still.sample);
      check("sample", sample, sample / reader_.rate_hz());
    }
    if (still.time) check("time", *still.time, *still.time);
    for (const double secs : options_.view.views->TimesInOrder()) {
      CheckReach(fmt::format("--views={}", options_.view.views.ToText()), secs, plan_.source);
    }
    check("start", *clip.start, *clip.start);
    if (clip.seconds) check("seconds", *clip.seconds, *clip.start + *clip.seconds);
    if (clip.end) check("end", *clip.end, *clip.end);
  }

  void AddOutput(const Output& output) {
    const bool is_up_to_date = check_.IsUpToDate(output);
    if (output.kind == OutputKind::kStill) {
      const auto& layer = options_.moment.overlay_layer;
      const auto format = layer ? std::optional(*layer) : std::nullopt;
      StillTask& task = TaskOf(stills_, output.camera, Fit::kNow, [&](RenderPlanner planner) {
        return StillTask(std::move(planner), format);
      });
      AddWriter(output, is_up_to_date, task);
    } else {
      // A source that can be read only once has no first pass.
      const Fit fit = provenance_.is_repeatable() ? Fit::kClip : Fit::kOff;
      ClipTask& task = TaskOf(clips_, output.camera, fit,
                              [](RenderPlanner planner) { return ClipTask(std::move(planner)); });
      AddWriter(output, is_up_to_date, task);
    }
  }

  template <class Task, class MakeTask>
  Task& TaskOf(std::map<std::string, Task>& tasks, const std::string& camera, Fit fit,
               MakeTask make) {
    const auto found = tasks.find(camera);
    if (found != tasks.end()) return found->second;
    ViewOptions view = options_.view;
    view.camera.Parse(camera);
    RenderPlanner planner(view, additions_, fit);
    if (!track_.empty()) {
      planner.ShowMarks([this](const SceneState& state) { return CaptionsAt(track_, state); });
    }
    return tasks.emplace(camera, make(std::move(planner))).first->second;
  }

  template <class Task>
  void AddWriter(const Output& output, bool is_up_to_date, Task& task) {
    const RunContext run = {options_, plan_.source, settings_, provenance_, grid_};
    OutputWriter& writer = writers_.emplace_back(run, output, is_up_to_date);
    if (!is_up_to_date) task.AddOutput(writer);
  }

  bool HasMoments() const { return options_.view.views->has_times(); }
  bool HasStills() const { return HasOutputs(stills_); }
  bool HasClips() const { return HasOutputs(clips_); }

  template <class Tasks>
  static bool HasOutputs(const Tasks& tasks) {
    return std::any_of(tasks.begin(), tasks.end(),
                       [](const auto& task) { return task.second.HasOutputs(); });
  }

  // A source is read once more where pictures depend on scenes after them.
  void Prescan() {
    std::vector<RenderPlanner*> planners;
    const auto add_from = [&](auto& tasks) {
      for (auto& [camera, task] : tasks) {
        if (task.HasOutputs() && task.planner().needs_prescan()) {
          planners.push_back(&task.planner());
        }
      }
    };
    add_from(stills_);
    add_from(clips_);
    if (planners.empty()) return;
    if (!provenance_.is_repeatable()) {
      throw UsageError(plan_.source +
                       ": can be read only once, but --plot, --orbit=turn and --fit=clip need two "
                       "passes; save it to a file first");
    }
    std::optional<double> end;
    if (grid_.length_nanos) end = Secs(grid_.start_nanos + *grid_.length_nanos);
    if (end && options_.moment.time) end = std::max(*end, *options_.moment.time);
    SceneReader reader(plan_.source, people_);
    // With the samples at both ends.
    const int samples = end ? static_cast<int>(*end * reader.rate_hz() + 1e-6) + 1 : 0;
    Progress progress("first pass, samples:", samples);
    PrescanClip(planners, reader, end, [&progress] { progress.Step(); });
  }

  // For the progress line; 0: unknown.
  long CountPictures() const {
    const auto stills = std::count_if(
        writers_.begin(), writers_.end(),
        [](const OutputWriter& writer) { return writer.is_still() && !writer.is_up_to_date(); });
    const auto clip_cameras = std::count_if(
        clips_.begin(), clips_.end(), [](const auto& task) { return task.second.HasOutputs(); });
    if (clip_cameras == 0) return stills;
    const std::optional<long> count = grid_.count();
    return count ? stills + clip_cameras * *count : 0;
  }

  // Up to the first picture; 0: unknown.
  double SecsBeforePictures() const {
    if (HasMoments()) return options_.view.views->TimesInOrder().back();
    std::optional<double> first;
    if (HasClips()) first = Secs(grid_.start_nanos);
    if (HasStills() && options_.moment.time) {
      const double still = *options_.moment.time;
      first = std::min(first.value_or(still), still);
    }
    return first.value_or(0);
  }

  void CheckStop() const {
    if (!StopRequested()) return;
    std::string left;
    bool is_sequence = false;
    for (const OutputWriter& writer : writers_) {
      if (writer.is_up_to_date()) continue;
      left += (left.empty() ? "" : ", ") + writer.output().path;
      is_sequence = is_sequence || writer.output().kind == OutputKind::kSequence;
    }
    throw std::runtime_error("interrupted; not finished: " + left +
                             (is_sequence ? " (run the same command again to resume)" : ""));
  }

  // The next sample; the one that a still by number shows is rendered as it passes.
  std::shared_ptr<const SceneState> Next() {
    CheckStop();
    auto state = reader_.Next();
    if (state == nullptr) return state;
    const long number = samples_++;
    if (!start_nanos_) start_nanos_ = state->stamp_nanos;
    newest_nanos_ = state->stamp_nanos;
    for (; reading_ && read_secs_ < Secs(newest_nanos_ - *start_nanos_) - 1; ++read_secs_) {
      reading_->Step();
    }
    if (still_is_rendered_) return state;
    for (auto& [camera, task] : stills_) task.Remember(*state);
    if (!HasMoments() && !options_.moment.time && number == options_.moment.sample.value_or(0L)) {
      RenderStills(*state);
    }
    return state;
  }

  void ReadUpToStill() {
    while (!still_is_rendered_) {
      if (Next() == nullptr) {
        throw UsageError(fmt::format("--sample={}: {} has only {} samples, counted from 0",
                                     options_.moment.sample.value_or(0L), plan_.source, samples_));
      }
    }
  }

  // The pictures of clips, and a still by time.
  void RenderAtTimes() {
    SceneTimeline timeline([this] { return Next(); });
    std::optional<std::int64_t> still_nanos;
    if (HasStills() && options_.moment.time) {
      still_nanos = std::llround(*options_.moment.time * 1e9);
    }
    Moments moments(still_nanos, HasClips() ? std::optional(grid_) : std::nullopt);
    while (const auto moment = moments.Next()) {
      const auto scene = timeline.AtNanos(moment->nanos);
      if (!moment->picture) {
        if (!scene) ThrowEndsBefore("time", *options_.moment.time);
        RenderStills(*scene);
      } else if (scene) {
        RenderClips(*moment->picture, *scene);
      } else {
        CheckHasPictures();
        moments.EndClip();
      }
    }
  }

  // One picture of several moments. (Clips have none: output_plan.cc.)
  void RenderMoments() {
    SceneTimeline timeline([this] { return Next(); });
    for (const double secs : options_.view.views->TimesInOrder()) {
      const auto scene = timeline.At(secs);
      if (!scene) {
        throw UsageError(fmt::format("--views={}: {} ends before {} s, at {:.3f} s",
                                     options_.view.views.ToText(), plan_.source, secs,
                                     Secs(newest_nanos_ - start_nanos_.value_or(0))));
      }
      for (auto& [camera, task] : stills_) {
        if (task.HasOutputs()) task.planner().AddMoment(*scene);
      }
    }
    reading_.reset();
    for (auto& [camera, task] : stills_) {
      if (task.HasOutputs()) task.DrawMoments(pool_, *progress_);
    }
  }

  // A clip without any is an error.
  void CheckHasPictures() const {
    if (clip_pictures_ > 0) return;
    if (samples_ > 0 && grid_.start_nanos > 0) ThrowEndsBefore("start", *options_.clip.start);
    throw UsageError(plan_.source + ": contains no sample to render");
  }

  [[noreturn]] void ThrowEndsBefore(const char* option, double secs) const {
    throw UsageError(fmt::format("--{}={}: {} ends before this time, at {:.3f} s", option, secs,
                                 plan_.source, Secs(newest_nanos_ - start_nanos_.value_or(0))));
  }

  void RenderStills(const SceneState& scene) {
    still_is_rendered_ = true;
    reading_.reset();
    const double secs = Secs(scene.stamp_nanos - *start_nanos_);
    for (auto& [camera, task] : stills_) {
      if (task.HasOutputs()) task.Draw(scene, secs, pool_, *progress_);
    }
  }

  void RenderClips(long k, const SceneState& scene) {
    CheckStop();
    reading_.reset();
    for (auto& [camera, task] : clips_) {
      if (task.HasOutputs()) task.Draw(k, scene, check_, pool_, *progress_);
    }
    clip_pictures_ = k + 1;
  }

  const RenderOptions& options_;
  const SourcePlan& plan_;
  const RunSettings& settings_;
  DrawPool& pool_;
  const SceneOptions people_;
  SceneReader reader_;
  const TimeGrid grid_;
  const Provenance provenance_;
  const ResumeCheck check_;
  const SceneAdditions additions_;  // of every planner
  const marks::MarkTrack track_;
  std::map<std::string, StillTask> stills_;  // by camera
  std::map<std::string, ClipTask> clips_;
  std::optional<std::int64_t> start_nanos_;  // of the first sample
  std::int64_t newest_nanos_ = 0;            // of the last one read
  std::optional<Progress> progress_;         // once there is something to do
  std::optional<Progress> reading_;          // up to the first picture
  int read_secs_ = 0;                        // whole ones, of it
  long samples_ = 0;                         // read so far
  bool still_is_rendered_ = false;
  long clip_pictures_ = 0;            // of each clip, so far
  std::deque<OutputWriter> writers_;  // last: their threads use the other members
};

}  // namespace

std::vector<OutputResult> RenderSource(const RenderOptions& options, const SourcePlan& plan,
                                       const RunSettings& settings, DrawPool& pool) {
  return RenderRun(options, plan, settings, pool).Run();
}

}  // namespace kinescope::app
