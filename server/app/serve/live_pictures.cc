#include "server/app/serve/live_pictures.h"

#include <algorithm>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "render/camera/camera.h"
#include "render/image/png_file.h"

namespace kinescope::app {
namespace {

constexpr int kJpegQuality = 85;

bool IsNamedCamera(const std::string& name) {
  const auto& names = render::CameraNames();
  return std::find(names.begin(), names.end(), name) != names.end();
}

// What is not of now is not called live.
std::shared_ptr<const SceneState> AsRecording(const SceneState& state) {
  auto recording = std::make_shared<SceneState>(state);
  recording->arrival_nanos = recording->waited_nanos = 0;
  return recording;
}

}  // namespace

LivePictures::LivePictures(const LivePictureSettings& settings, RendererFactory make_renderer,
                           const std::shared_ptr<const SceneState>& first,
                           Latest<http::Picture>& pictures)
    : moves_(settings.moves),
      own_(settings.camera.name().empty() ? std::optional(settings.camera) : std::nullopt),
      trails_(settings.trails),
      history_(settings.history),
      pictures_(pictures),
      camera_(own_ ? http::kOwnCamera : settings.camera.name()),
      live_({"picture", settings.width, settings.height, settings.rate_hz, settings.people,
             settings.background, settings.trails},
            settings.camera, make_renderer, first,
            [this](const render::Image& image, const SceneState& state, const render::Camera&) {
              Publish(image, state);
            }),
      snapshots_({"snapshot", settings.width, settings.height, settings.rate_hz, settings.people,
                  settings.background, settings.trails},
                 settings.camera, std::move(make_renderer), first, nullptr) {
  // The first viewer receives a picture at once.
  Publish(live_.Request(LiveView(settings.width, settings.height)).get(), *first);
}

void LivePictures::Publish(const render::Image& image, const SceneState& state) {
  auto picture = std::make_shared<http::Picture>();
  picture->jpeg = render::EncodeJpeg(image, kJpegQuality);
  picture->state_number = state.number;
  picture->arrival_nanos = state.arrival_nanos;
  pictures_.Publish(std::move(picture));
}

std::optional<CameraController> LivePictures::Named(const std::string& camera,
                                                    const CameraOptions& moves) const {
  if (camera == http::kOwnCamera) return own_;
  if (!IsNamedCamera(camera)) return std::nullopt;
  return CameraController(ParseCamera(camera), moves);
}

bool LivePictures::SetCamera(const std::string& camera) {
  auto named = Named(camera, moves_);
  if (!named) return false;
  // The selected camera is not started again.
  if (camera != camera_) live_.SetCamera(*std::move(named));
  camera_ = camera;
  return true;
}

std::vector<std::uint8_t> LivePictures::SnapshotPng(const http::SnapshotRequest& request) {
  return render::EncodePng(Order(request).get());
}

std::future<render::Image> LivePictures::Order(const http::SnapshotRequest& request) {
  const std::string& camera = request.camera;
  render::PictureSpec view{request.width, request.height, 2, "", true};
  if (request.is_dark) view.look.theme = render::Theme::kDark;
  std::shared_ptr<const SceneState> former;
  if (request.state) {
    view.look.trails = TrailsUpTo(*request.state);
    former = AsRecording(*request.state);
  }
  std::optional<CameraController> named;
  if (!camera.empty()) {
    // A former moment has lens and framing of the live picture in whose place it is shown.
    named = Named(camera, former ? moves_ : CameraOptions());
    if (!named) throw UsageError("camera=" + camera + ": unknown camera");
  }
  if (named) return snapshots_.Request(view, std::move(named), former);
  return snapshots_.RequestAimed(
      view,
      [this, former](const render::ViewShape& shape) {
        return former ? live_.AimAlone(*former, shape) : live_.AimLive(shape);
      },
      former);
}

std::vector<render::Trail> LivePictures::TrailsUpTo(const SceneState& state) const {
  Trails trails(trails_);
  if (trails.empty() || history_ == nullptr) return {};
  const auto nanos = static_cast<std::int64_t>(trails_.secs * kNanosPerSecond);
  history_->Visit({state.made_nanos - nanos, state.made_nanos, 0}, [&](const SceneState& each) {
    trails.Remember(each);
    return true;
  });
  return trails.Make();
}

DrawingStatus LivePictures::status() const {
  DrawingStatus status = live_.status();
  DrawingStatus snapshots = snapshots_.status();
  status.drawn += snapshots.drawn;
  status.hangs = status.hangs || snapshots.hangs;
  if (status.last_error.empty()) status.last_error = std::move(snapshots.last_error);
  if (snapshots.drawn_at > status.drawn_at) status.problems = std::move(snapshots.problems);
  return status;
}

}  // namespace kinescope::app
