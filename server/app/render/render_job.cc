#include "server/app/render/render_job.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <tuple>
#include <utility>

#include "core/clocks.h"
#include "core/errors.h"
#include "core/stop_signal.h"
#include "server/app/progress.h"
#include "server/app/render/output_sink.h"
#include "server/app/render/provenance.h"
#include "server/picture/backend.h"
#include "server/scene/scene_reader.h"

namespace kinescope::app {
namespace {

// An output while it is made.
struct Running {
  Output output;
  Json provenance;
  OutputResult result;
  std::unique_ptr<OutputSink> sink;  // from the first picture on
  Json first_camera;
  bool is_finished = false;  // was there already
};

// Stills do not follow what clips do before them.
struct PlannerKey {
  std::string camera;
  bool is_still = false;
  bool operator<(const PlannerKey& other) const {
    return std::tie(camera, is_still) < std::tie(other.camera, other.is_still);
  }
};

class Job {
 public:
  Job(const RenderOptions& options, const SourcePlan& plan, const JobSettings& settings,
      DrawPool& pool)
      : options_(options),
        plan_(plan),
        settings_(settings),
        pool_(pool),
        people_(ToShownSceneOptions(options.person, options.loads)),
        reader_(plan.source, people_),
        grid_(ToTimeGrid(options.clip, IsSubjectUrl(plan.source))),
        provenance_(options, plan.source, pool.info()),
        additions_(options.view, options.backend, people_) {
    for (const Output& output : plan.outputs) AddOutput(output);
    if (HasWork(true) || HasWork(false)) Survey();
  }

  std::vector<OutputResult> Run() {
    if (HasWork(true) || HasWork(false)) {
      MakeProgress();
      ReadAndDraw();
      Finish();
    }
    std::vector<OutputResult> results;
    for (Running& each : running_) {
      each.result.took_secs = progress_ ? progress_->secs() : 0;
      results.push_back(each.result);
    }
    return results;
  }

 private:
  void AddOutput(const Output& output) {
    Running run{output, provenance_.Of(output), {output.path, output.kind}, nullptr, {}, false};
    run.is_finished = !settings_.force && provenance_.is_repeatable() &&
                      output.kind != OutputKind::kSequence &&
                      IsFinished(output, run.provenance, settings_.sidecar);
    if (run.is_finished && settings_.sidecar) {
      const Json pictures =
          ReadSidecar(output.path).value_or(Json::object()).value("pictures", Json());
      if (pictures.is_number_integer()) run.result.pictures = pictures.get<long>();
    }
    const PlannerKey key{output.camera, output.kind == OutputKind::kStill};
    if (planners_.count(key) == 0) {
      ViewOptions view = options_.view;
      view.camera.Parse(output.camera);
      planners_.try_emplace(key, view, additions_);
    }
    if (output.kind == OutputKind::kClip && !run.is_finished) {
      // What cannot be written or encoded is said now, not after the first picture.
      const render::View& view = planners_.at(key).view();
      render::MakeVideoWriter(output.path, view.width, view.height, PackingOf(output));
    }
    running_.push_back(std::move(run));
  }

  render::VideoOptions PackingOf(const Output& output) const {
    render::VideoOptions options;
    options.rate = grid_.rate;
    if (HasCrf(output.path) && options_.pack.crf) {
      options.crf = static_cast<int>(*options_.pack.crf);
    }
    options.quality = static_cast<int>(*options_.pack.quality);
    options.alpha = options_.view.background->is_transparent;
    return options;
  }

  // A source is read once more where pictures depend on scenes after them.
  void Survey() {
    std::vector<ShotPlanner*> planners;
    for (auto& [key, planner] : planners_) {
      if (planner.needs_survey()) planners.push_back(&planner);
    }
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
    SurveyClip(planners, reader, end);
  }

  // Whether an output that is no still (a still) is to be made.
  bool HasWork(bool of_stills) const {
    for (const Running& each : running_) {
      if (!each.is_finished && (each.output.kind == OutputKind::kStill) == of_stills) return true;
    }
    return false;
  }

  // Whether a picture of the clip seen by that camera is wanted by `run`.
  bool Wants(const Running& run, const std::string& camera, long k) const {
    if (run.is_finished || run.output.kind == OutputKind::kStill || run.output.camera != camera) {
      return false;
    }
    if (settings_.only_picture && *settings_.only_picture != k) return false;
    if (run.output.kind == OutputKind::kClip || settings_.force || !provenance_.is_repeatable()) {
      return true;
    }
    const auto there = ReadEmbedded(PathOfPicture(run.output.path, k));
    return !there || !DecideTheSame(*there, provenance_.Of(run.output, k));
  }

  void MakeProgress() {
    std::set<std::string> clip_cameras;
    int stills = 0;
    for (const Running& each : running_) {
      if (each.is_finished) continue;
      if (each.output.kind == OutputKind::kStill) {
        ++stills;
      } else {
        clip_cameras.insert(each.output.camera);
      }
    }
    const std::optional<long> count = grid_.count();
    const bool is_known = clip_cameras.empty() || count;
    const long total = stills + static_cast<long>(clip_cameras.size()) * count.value_or(0);
    progress_ = std::make_unique<Progress>("pictures:", is_known ? static_cast<int>(total) : 0);
  }

  void CheckStop() const {
    if (!StopRequested()) return;
    std::string left;
    bool is_sequence = false;
    for (const Running& each : running_) {
      if (each.is_finished) continue;
      left += (left.empty() ? "" : ", ") + each.output.path;
      is_sequence = is_sequence || each.output.kind == OutputKind::kSequence;
    }
    throw std::runtime_error("interrupted; not finished: " + left +
                             (is_sequence ? " (run the same command again to resume)" : ""));
  }

  // The next sample; the one that a still by number shows is drawn as it passes.
  std::shared_ptr<const SceneState> Next() {
    CheckStop();
    auto state = reader_.Next();
    if (state == nullptr) return state;
    const long number = samples_++;
    if (!start_nanos_) start_nanos_ = state->stamp_nanos;
    for (auto& [key, planner] : planners_) {
      if (key.is_still && !still_is_drawn_ && planner.history_secs() > 0) planner.Remember(*state);
    }
    if (HasWork(true) && !options_.moment.time && number == options_.moment.frame.value_or(0L)) {
      DrawStills(*state);
    }
    return state;
  }

  void ReadAndDraw() {
    const bool has_moment = HasWork(true) && options_.moment.time;
    if (HasWork(false) || has_moment) DrawAtTimes(has_moment);
    const bool has_number = HasWork(true) && !options_.moment.time;
    while (has_number && !still_is_drawn_) {
      if (Next() == nullptr) {
        throw UsageError(fmt::format("--sample={}: {} has only {} samples, counted from 0",
                                     options_.moment.frame.value_or(0L), plan_.source, samples_));
      }
    }
  }

  // The pictures of clips and the moment of a still, by time.
  void DrawAtTimes(bool has_moment) {
    SceneTimeline timeline([this] { return Next(); });
    const std::int64_t moment =
        has_moment ? std::llround(*options_.moment.time * 1e9) : std::int64_t{0};
    bool has_clips = HasWork(false);
    for (long k = 0; has_clips || has_moment;) {
      if (has_moment && (!has_clips || moment <= grid_.NanosOf(k))) {
        auto scene = timeline.AtNanos(moment);
        if (!scene) {
          throw UsageError(
              fmt::format("--time={}: {} ends before this time; choose an earlier one this time; "
                          "choose an earlier one",
                          *options_.moment.time, plan_.source));
        }
        DrawStills(*scene);
        has_moment = false;
        continue;
      }
      auto scene = grid_.Has(k) ? timeline.AtNanos(grid_.NanosOf(k)) : std::nullopt;
      if (scene) {
        DrawClips(k++, *scene);
      } else {
        has_clips = false;
        CheckNotEmpty(k);
        clip_pictures_ = k;
      }
    }
  }

  void CheckNotEmpty(long pictures) const {
    if (pictures > 0) return;
    if (samples_ > 0 && grid_.start_nanos > 0) {
      throw UsageError(fmt::format("--start={}: {} ends before this time; choose an earlier one",
                                   *options_.clip.start, plan_.source));
    }
    throw UsageError(plan_.source + ": contains no sample to render");
  }

  // A picture is let go of before the next one is drawn: the pool may have room for one alone.
  void DrawStills(const SceneState& scene) {
    still_is_drawn_ = true;
    const double secs = Secs(scene.stamp_nanos - *start_nanos_);
    for (const auto& [key, planner] : planners_) {
      if (!key.is_still) continue;
      std::vector<Running*> takers;
      for (Running& run : running_) {
        const bool is_still = run.output.kind == OutputKind::kStill;
        if (is_still && !run.is_finished && run.output.camera == key.camera) takers.push_back(&run);
      }
      if (takers.empty()) continue;
      Shot shot = planner.Only(scene, secs);
      if (options_.moment.overlay_layer) {
        shot.layer = *options_.moment.overlay_layer;
        shot.view.overlays = false;
      }
      const render::Camera pose = shot.camera;
      const FuturePicture picture = pool_.Draw(std::move(shot));
      for (Running* run : takers) {
        run->result.counter = scene.counter;
        Put(*run, 0, picture, pose);
        progress_->Step();
      }
    }
  }

  void DrawClips(long k, const SceneState& scene) {
    CheckStop();
    for (auto& [key, planner] : planners_) {
      if (key.is_still) continue;
      const std::string& camera = key.camera;
      std::vector<Running*> takers;
      bool is_seen = false;
      for (Running& run : running_) {
        const bool is_of_camera = run.output.kind != OutputKind::kStill && !run.is_finished &&
                                  run.output.camera == camera;
        is_seen = is_seen || is_of_camera;
        if (Wants(run, camera, k)) takers.push_back(&run);
      }
      if (!is_seen) continue;
      Shot shot = planner.Next(scene);  // also of what is there already: it follows the person
      if (takers.empty()) {
        progress_->Skip();
        continue;
      }
      const render::Camera pose = shot.camera;
      const FuturePicture picture = pool_.Draw(std::move(shot));
      for (Running* run : takers) Put(*run, k, picture, pose);
      progress_->Step();
    }
  }

  void Put(Running& run, long k, const FuturePicture& picture, const render::Camera& camera) {
    if (run.sink == nullptr) {
      run.sink = MakeSink(run);
      run.first_camera = Describe(camera);
    }
    run.sink->Put(k, picture, camera);
    ++run.result.drawn;
  }

  std::unique_ptr<OutputSink> MakeSink(const Running& run) const {
    const bool is_numbered = run.output.kind == OutputKind::kSequence;
    const MetadataOf text = [this, output = run.output, is_numbered](const render::Camera& camera,
                                                                     long k) {
      Json provenance = provenance_.Of(output, is_numbered ? std::optional<long>(k) : std::nullopt);
      provenance["camera"] = Describe(camera);
      return MetadataFor(output, provenance);
    };
    if (is_numbered) return MakePngSink(run.output.path, settings_.jobs, text);
    if (run.output.kind == OutputKind::kStill) {
      return MakePngSink(run.output.path, 1, text, LayerPathOf(run.output));
    }
    return MakeClipSink(run.output.path, planners_.at({run.output.camera, false}).view(),
                        PackingOf(run.output), text);
  }

  std::map<std::string, std::string> MetadataFor(const Output& output,
                                                 const Json& provenance) const {
    std::map<std::string, std::string> text;
    if (!options_.view.title->empty()) {
      text[output.kind == OutputKind::kClip ? "title" : "Title"] = *options_.view.title;
    }
    if (output.kind == OutputKind::kClip) {
      text["comment"] = ToText(provenance);
      return text;
    }
    text["Software"] = "Kinescope " KINESCOPE_VERSION;
    text["Source"] = provenance.at("source").at("name");
    text["Camera"] = output.camera;
    text["Renderer"] = provenance.at("renderer");
    text[kProvenanceKey] = ToText(provenance);
    return text;
  }

  void Finish() {
    for (Running& run : running_) {
      if (run.is_finished) continue;
      if (run.sink != nullptr) run.sink->Finish();
      const bool is_still = run.output.kind == OutputKind::kStill;
      run.result.pictures = is_still ? 1 : clip_pictures_;
      run.result.secs =
          is_still ? 0 : static_cast<double>(grid_.rate.NanosOf(clip_pictures_)) * 1e-9;
      const bool is_whole = !settings_.only_picture;
      if (!settings_.sidecar || !is_whole || run.result.drawn == 0) continue;
      Json provenance = run.provenance;
      provenance["camera"] = run.first_camera;
      WriteSidecar(run.output, std::move(provenance), plan_.source, run.result.pictures);
    }
  }

  // "" where what is written over the picture stays in it.
  std::string LayerPathOf(const Output& output) const {
    if (!options_.moment.overlay_layer) return "";
    return std::filesystem::path(output.path)
        .replace_extension(options_.moment.overlay_layer.ToText());
  }

  const RenderOptions& options_;
  const SourcePlan& plan_;
  const JobSettings& settings_;
  DrawPool& pool_;
  const SceneOptions people_;
  SceneReader reader_;
  const TimeGrid grid_;
  const Provenance provenance_;
  const SceneAdditions additions_;  // of every planner
  std::map<PlannerKey, ShotPlanner> planners_;
  std::optional<std::int64_t> start_nanos_;  // of the first sample
  std::unique_ptr<Progress> progress_;       // once there is something to do
  long samples_ = 0;                         // read so far
  bool still_is_drawn_ = false;
  long clip_pictures_ = 0;
  std::vector<Running> running_;  // last: their threads use what is above
};

// Each renderer says once what is wrong with a mesh; all of them together, too.
render::LogLine LogOnce() {
  struct Said {
    std::mutex mutex;
    std::set<std::string> lines;  // guarded by mutex
  };
  return [said = std::make_shared<Said>()](const std::string& line) {
    const std::lock_guard lock(said->mutex);
    if (said->lines.insert(line).second) spdlog::warn("{}", line);
  };
}

}  // namespace

std::vector<OutputResult> RenderSource(const RenderOptions& options, const SourcePlan& plan,
                                       const JobSettings& settings, DrawPool& pool) {
  return Job(options, plan, settings, pool).Run();
}

std::unique_ptr<DrawPool> MakeDrawPool(int jobs, const render::View& view,
                                       const BackendOptions& backend) {
  const BackendChoice choice = ChooseBackend(backend);
  if (!choice.note.empty()) spdlog::warn("pictures: {}", choice.note);
  return std::make_unique<DrawPool>(
      jobs, MostPictures(jobs, view.width, view.height),
      [backend, choice, log = LogOnce()] { return StartRenderer(backend, choice, {}, log); });
}

}  // namespace kinescope::app
