/// Renders the pictures of the page: the live picture as JPEG, while it has viewers, and snapshots
/// as PNG, on a thread and with a renderer of their own, so that a large one does not delay the
/// live picture; that renderer is made for the first snapshot. A camera that a viewer selects keeps
/// the camera options of the live picture. A snapshot without a camera is taken by the camera of
/// the live picture; a named camera has no options. Snapshots of former states have those of the
/// live picture, are called a recording, and show the trails that ended there.
#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/scene_state.h"
#include "core/system/latest.h"
#include "server/history/history.h"
#include "server/http/server.h"
#include "server/picture/backend.h"
#include "server/picture/camera_controller.h"
#include "server/picture/camera_options.h"
#include "server/picture/drawing_loop.h"
#include "server/picture/people_look.h"

namespace kinescope::app {

struct LivePictureSettings {
  CameraController camera{{"three_quarter", std::nullopt, false}, {}};  // until one is selected
  CameraOptions moves;  // of `camera` and of those that viewers select
  int width = 1280;
  int height = 720;
  double rate_hz = 30;  // maximum frame rate
  PeopleLook people = {};
  std::optional<Rgb> background = {};  // instead of that of the viewer's theme
  TrailSettings trails = {};
  const history::History* history = nullptr;  // of the trails of former states; may be null
};

class LivePictures : public http::PictureFeed {
 public:
  /// Returns when the first picture (of `first`) is published.
  /// @throws what the renderer throws. Ends the process (exit code 2) if the driver does not
  /// respond.
  LivePictures(const LivePictureSettings& settings, RendererFactory make_renderer,
               const std::shared_ptr<const SceneState>& first, Latest<http::Picture>& pictures);

  /// Any thread; never waits for rendering.
  void OnState(std::shared_ptr<const SceneState> state) {
    snapshots_.OnState(state);
    live_.OnState(std::move(state));
  }

  void SetViewers(int count) override { live_.SetViewers(count); }
  [[nodiscard]] bool SetCamera(const std::string& camera) override;
  void SetDark(bool is_dark) override { live_.SetDark(is_dark); }
  std::vector<std::uint8_t> SnapshotPng(const http::SnapshotRequest& request) override;
  /// The same as pixels, when it is drawn. Any thread; does not wait for rendering.
  /// @throws what DrawingLoop::Request throws
  std::future<render::Image> Order(const http::SnapshotRequest& request);

  /// Of the live picture and the snapshots together.
  DrawingStatus status() const;

 private:
  void Publish(const render::Image& image, const SceneState& state);
  std::vector<render::Trail> TrailsUpTo(const SceneState& state) const;

  /// Of a selected name; null: there is none of that name.
  std::optional<CameraController> Named(const std::string& camera,
                                        const CameraOptions& moves) const;

  const CameraOptions moves_;
  const std::optional<CameraController> own_;  // http::kOwnCamera
  const TrailSettings trails_;
  const history::History* const history_;
  Latest<http::Picture>& pictures_;
  std::string camera_;  // name of the live picture's; used by the thread that calls SetCamera
  // Last: they use all other members.
  DrawingLoop live_;
  DrawingLoop snapshots_;  // it asks live_ for its camera
};

}  // namespace kinescope::app
