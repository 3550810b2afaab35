/// Renders the server's pictures on its own thread: the live picture for the page, while it has
/// viewers, and snapshots on request. States may arrive at any rate; the frame rate is at most
/// `rate_hz`.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/latest.h"
#include "core/scene_state.h"
#include "render/renderer.h"
#include "server/http/server.h"
#include "server/picture/backend.h"
#include "server/picture/camera_controller.h"

namespace kinescope::app {

struct PictureOptions {
  CameraChoice camera = {"three_quarter", std::nullopt, false};
  int width = 1280;
  int height = 720;
  double rate_hz = 30;
  CameraOptions moves = {};  // of the live picture
  BackendOptions backend = {};
};

struct PictureStatus {
  render::RendererInfo renderer;
  std::uint64_t drawn = 0;   // live pictures and snapshots rendered
  double draw_millis = 0;    // of the last one, rendered and read back
  double encode_millis = 0;  // of the last JPEG
  std::string last_error;    // "" if the last picture succeeded
  bool hangs = false;        // the driver does not respond; last_error contains the operation
  /// The elements that the newest picture replaces by labelled boxes (render::Renderer::problems).
  std::vector<std::string> problems;
};

class PictureLoop : public http::PictureFeed {
 public:
  /// Returns after the first picture (of `first`) was rendered.
  /// @throws render::RenderError if there is no renderer, UsageError for invalid options.
  PictureLoop(const PictureOptions& options, std::shared_ptr<const SceneState> first,
              Latest<http::Picture>& pictures);
  /// Ends the process (exit code 2) if the driver does not respond, because the thread cannot be
  /// joined then.
  ~PictureLoop() override;

  void OnState(std::shared_ptr<const SceneState> state);  // any thread; never waits for rendering

  void SetViewers(int count) override;
  [[nodiscard]] bool SetCamera(const std::string& camera) override;
  std::vector<std::uint8_t> SnapshotPng(const std::string& camera, int width, int height) override;

  PictureStatus status() const;

 private:
  struct Snapshot {
    std::string camera;
    int width, height;
    std::promise<std::vector<std::uint8_t>> png;
  };

  void Run(std::promise<void> started);
  void DrawLive(render::Renderer& renderer, const SceneState& state, const std::string& camera);
  void DrawSnapshot(render::Renderer& renderer, const SceneState& state);
  void OnHang(const std::string& what);  // on the thread of the renderer's watchdog
  void OnDrawn(render::Renderer& renderer);

  const PictureOptions options_;
  Latest<http::Picture>& pictures_;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  // Guarded by mutex_:
  std::shared_ptr<const SceneState> state_;
  std::string camera_;
  int viewers_ = 0;
  bool live_is_due_ = false;  // the newest state, camera or viewer count was not rendered yet
  bool stop_ = false;
  std::deque<std::unique_ptr<Snapshot>> snapshots_;
  std::unique_ptr<Snapshot> in_hand_;  // being rendered; the thread that takes it away answers it
  bool has_started_ = false;
  PictureStatus status_;
  // Used by the rendering thread only:
  render::Image live_image_;
  std::string live_camera_name_;
  std::optional<CameraController> live_camera_;  // a new name is a cut

  std::thread thread_;
};

}  // namespace kinescope::app
