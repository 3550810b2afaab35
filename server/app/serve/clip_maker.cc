#include "server/app/serve/clip_maker.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "core/system/clocks.h"
#include "render/video.h"
#include "server/app/marks_option.h"
#include "server/http/server.h"
#include "server/picture/render_planner.h"

namespace kinescope::app {
namespace {

constexpr std::chrono::milliseconds kWaitStep(50);

}  // namespace

// False: it is not wanted any more. A stream that has stopped brings no newer state.
bool ClipMaker::Await(std::int64_t nanos, const Workshop::Progress& progress) const {
  constexpr std::int64_t kGrace = kNanosPerSecond / 2;
  while (progress.is_wanted()) {
    const auto extent = history_.extent();
    if ((extent && extent->last_nanos >= nanos) || MonotonicNanos() >= nanos + kGrace) return true;
    std::this_thread::sleep_for(kWaitStep);
  }
  return false;
}

SceneState ClipMaker::StateAt(std::int64_t nanos) const {
  const auto extent = history_.extent();
  const auto state = history_.At(nanos);
  if (!extent || state == nullptr || nanos < extent->first_nanos) {
    throw std::runtime_error(
        "the moments of this clip are no longer kept (--history_minutes); make it sooner, or "
        "render it from the recording");
  }
  SceneState shown = *state;
  shown.arrival_nanos = shown.waited_nanos = 0;  // it is a recording now, and called one
  return shown;
}

// Moments of other runs of the server have clocks of their own.
marks::MarkTrack ClipMaker::TrackOfThisRun() const {
  if (book_ == nullptr) return {};
  std::vector<marks::Mark> marks = book_->ChangedAfter(0, marks::kMostMarks);
  marks.erase(std::remove_if(
                  marks.begin(), marks.end(),
                  [&](const marks::Mark& mark) { return mark.run_micros != book_->run_micros(); }),
              marks.end());
  return {marks, marks::TrackClock::kServer};
}

void ClipMaker::Make(const ClipMakerOrder& order, Workshop::Progress& progress) const {
  const auto [from, to] = order.span;
  if (!Await(to, progress)) return;
  ViewOptions view = settings_.view;
  view.camera.Parse(order.camera == http::kOwnCamera ? settings_.own_camera : order.camera);
  view.title.Parse(order.title);
  RenderPlanner planner(view, SceneAdditions(view, settings_.backend, settings_.scene), Fit::kNow);
  const marks::MarkTrack track = TrackOfThisRun();
  planner.ShowMarks([&track](const SceneState& state) { return CaptionsAt(track, state); });
  const render::PictureSpec spec = planner.spec();
  render::VideoOptions video;
  video.rate = {kFramesPerSecond, 1};
  video.metadata = {{"title", order.title}};
  const auto writer = render::MakeVideoWriter(order.file, spec.width, spec.height, video);
  const auto renderer =
      make_renderer_([](const std::string& line) { spdlog::error("clip: {}", line); });
  const std::int64_t frames =
      std::max<std::int64_t>(1, (to - from) * kFramesPerSecond / kNanosPerSecond);
  render::Image image;
  for (std::int64_t k = 0; k < frames; ++k) {
    if (!progress.is_wanted()) return;
    const RenderRequest request = planner.Next(StateAt(from + video.rate.NanosOf(k)));
    renderer->RenderInto(image, request.state, request.camera, request.spec);
    writer->Add(image);
    progress.Set(static_cast<double>(k + 1) / static_cast<double>(frames));
  }
  writer->Finish();
}

}  // namespace kinescope::app
