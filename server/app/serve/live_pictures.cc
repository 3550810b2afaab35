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
      loop_({"picture", settings.width, settings.height, settings.rate_hz}, settings.camera,
            std::move(make_renderer), first,
            [this](const render::Image& image, const SceneState& state, const render::Camera&) {
              Publish(image, state);
            }) {
  // The first viewer receives a picture at once.
  Publish(loop_.Request({settings.width, settings.height, 1, "", true}).get(), *first);
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
  if (camera != camera_) loop_.SetCamera(CameraController(ParseCamera(camera), moves_));
  camera_ = camera;
  return true;
}

std::vector<std::uint8_t> LivePictures::SnapshotPng(const std::string& camera, int width,
                                                    int height) {
  std::optional<CameraController> named;
  if (!camera.empty()) {
    if (!IsNamedCamera(camera)) throw UsageError("camera=" + camera + ": unknown camera");
    named.emplace(ParseCamera(camera), CameraOptions());
  }
  return render::EncodePng(loop_.Request({width, height, 2, "", true}, std::move(named)).get());
}

}  // namespace kinescope::app
