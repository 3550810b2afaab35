#include "server/app/serve/live_pictures.h"

#include <algorithm>
#include <utility>

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

}  // namespace

LivePictures::LivePictures(const LivePictureSettings& settings, RendererFactory make_renderer,
                           const std::shared_ptr<const SceneState>& first,
                           Latest<http::Picture>& pictures)
    : moves_(settings.moves),
      pictures_(pictures),
      camera_(settings.camera.name()),
      live_({"picture", settings.width, settings.height, settings.rate_hz, settings.people,
             settings.trails},
            settings.camera, make_renderer, first,
            [this](const render::Image& image, const SceneState& state, const render::Camera&) {
              Publish(image, state);
            }),
      snapshots_({"snapshot", settings.width, settings.height, settings.rate_hz, settings.people,
                  settings.trails},
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

bool LivePictures::SetCamera(const std::string& camera) {
  if (!IsNamedCamera(camera)) return false;
  // The selected camera is not started again.
  if (camera != camera_) live_.SetCamera(CameraController(ParseCamera(camera), moves_));
  camera_ = camera;
  return true;
}

std::vector<std::uint8_t> LivePictures::SnapshotPng(const http::SnapshotRequest& request) {
  const std::string& camera = request.camera;
  render::PictureSpec view{request.width, request.height, 2, "", true};
  if (request.is_dark) view.look.theme = render::Theme::kDark;
  std::optional<CameraController> named;
  if (!camera.empty()) {
    if (!IsNamedCamera(camera)) throw UsageError("camera=" + camera + ": unknown camera");
    named.emplace(ParseCamera(camera), CameraOptions());
  }
  return render::EncodePng(
      (named ? snapshots_.Request(view, std::move(named))
             : snapshots_.RequestAimed(
                   view, [this](const render::ViewShape& shape) { return live_.AimLive(shape); }))
          .get());
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
