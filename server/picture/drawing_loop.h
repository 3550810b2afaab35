/// Renders the newest state on its own thread: the live picture while it has viewers, at most
/// `rate_hz` times per second, and single pictures on request, which go first, also of former
/// states. States may arrive at any rate; older ones are dropped. The renderer is made for the
/// first picture.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/scene_state.h"
#include "render/image/image.h"
#include "render/renderer.h"
#include "server/picture/backend.h"
#include "server/picture/camera_controller.h"
#include "server/picture/people_look.h"
#include "server/picture/picture_shapes.h"
#include "server/picture/trails.h"

namespace kinescope::app {

struct DrawingSettings {
  std::string name = "picture";  // begins the lines in the log
  int width = 1280;              // of the live picture, px
  int height = 720;
  double rate_hz = 30;                 // maximum frame rate of the live picture
  PeopleLook people = {};              // of all pictures
  std::optional<Rgb> background = {};  // of all pictures, with the theme that fits
  TrailSettings trails = {};
  std::function<std::chrono::steady_clock::time_point()> now = std::chrono::steady_clock::now;
};

struct DrawingStatus {
  render::RendererInfo renderer;  // empty before the first picture
  int viewers = 0;
  std::uint64_t drawn = 0;    // live and requested pictures
  double draw_millis = 0;     // of the last live picture, rendered and read back
  double deliver_millis = 0;  // of the last live picture, encoded or sent
  std::string last_error;     // "" if the last live picture succeeded
  bool hangs = false;         // the driver does not respond; last_error contains the operation
  /// The elements that the newest picture replaces by labelled boxes (render::Renderer::problems).
  std::vector<std::string> problems;
  std::chrono::steady_clock::time_point drawn_at{};  // the newest picture
};

/// What a live picture of this size, px, is: with overlays, one sample per pixel, and bodies of as
/// many triangles as can be seen.
render::PictureSpec LiveView(int width, int height);

class DrawingLoop {
 public:
  using Clock = std::chrono::steady_clock;
  /// Receives every live picture, on the drawing thread.
  using Deliver = std::function<void(const render::Image& image, const SceneState& state,
                                     const render::Camera& camera)>;
  using Aim = std::function<render::Camera(const render::ViewShape& shape)>;

  /// Requests that may wait; more would be a client that misbehaves.
  static constexpr std::size_t kMaxWaiting = 16;

  /// `make_renderer` is called on the drawing thread; if it fails, the next picture tries again.
  DrawingLoop(DrawingSettings settings, CameraController camera, RendererFactory make_renderer,
              std::shared_ptr<const SceneState> first, Deliver deliver);
  /// Ends the process (exit code 2) if the driver does not respond, because the thread cannot be
  /// joined then.
  ~DrawingLoop();
  DrawingLoop(const DrawingLoop&) = delete;
  DrawingLoop& operator=(const DrawingLoop&) = delete;

  // Any thread; these functions never wait for rendering.
  void OnState(std::shared_ptr<const SceneState> state);
  /// A new viewer receives a live picture as soon as the frame rate allows, even if the scene does
  /// not change.
  void SetViewers(int count);
  /// The theme of the live picture.
  void SetDark(bool is_dark);
  /// Cuts the live picture to `camera`.
  void SetCamera(CameraController camera);
  /// One picture beside the live ones; without `camera` by that of the live picture. `state`: a
  /// former one, with the trails of `view`; null: the newest. The future fails with what rendering
  /// threw, or std::runtime_error if the driver does not respond or the loop ends.
  /// @throws std::runtime_error if the driver does not respond, or if kMaxWaiting requests wait.
  std::future<render::Image> Request(const render::PictureSpec& view,
                                     std::optional<CameraController> camera = std::nullopt,
                                     std::shared_ptr<const SceneState> state = nullptr);
  /// As above, by the camera that `aim` returns for its shape when it is the picture's turn.
  std::future<render::Image> RequestAimed(const render::PictureSpec& view, Aim aim,
                                          std::shared_ptr<const SceneState> state = nullptr);
  /// Where the camera of the live picture is now, for a picture of this shape.
  render::Camera AimLive(const render::ViewShape& shape);
  /// Where it would be for a picture of `state` alone.
  render::Camera AimAlone(const SceneState& state, const render::ViewShape& shape) const;
  DrawingStatus status() const;

 private:
  struct Order {
    render::PictureSpec view;
    std::optional<CameraController> camera;
    Aim aim;                                  // null: `camera`, or that of the live picture
    std::shared_ptr<const SceneState> state;  // null: the newest
    std::promise<render::Image> picture;
  };

  std::future<render::Image> Enqueue(Order order);
  void Run();
  // Called with `lock` held, which they release while they wait or draw.
  bool WaitForWork(std::unique_lock<std::mutex>& lock);
  void DrawLive(std::unique_lock<std::mutex>& lock);
  void DrawOrder(std::unique_lock<std::mutex>& lock);
  // Called with mutex_ locked.
  render::PictureSpec LiveSpec() const;
  void NoteReturn();
  void NoteDrawn();
  void RefuseOrders(const std::string& reason);

  render::Renderer& StartedRenderer();
  void OnHang(const std::string& what);  // on the thread of the renderer's watchdog

  const DrawingSettings settings_;
  const Clock::duration period_;
  const RendererFactory make_renderer_;
  const Deliver deliver_;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  // Guarded by mutex_:
  std::shared_ptr<const SceneState> state_;
  CameraController camera_;  // of the live picture
  Trails trails_;
  PictureShapes shapes_;
  bool live_is_due_ = false;  // the newest state, camera, theme or viewer has no picture yet
  bool is_dark_ = false;      // the live picture
  bool stop_ = false;
  std::deque<Order> orders_;
  /// Of the order being drawn; answered by the thread that takes it: the drawing thread, or the
  /// watchdog's while the driver does not respond.
  std::optional<std::promise<render::Image>> in_hand_;
  DrawingStatus status_;
  // Used by the drawing thread only:
  Clock::time_point next_live_;  // not before it
  std::unique_ptr<render::Renderer> renderer_;
  render::Image live_image_;

  std::thread thread_;  // last: it uses all other members
};

}  // namespace kinescope::app
