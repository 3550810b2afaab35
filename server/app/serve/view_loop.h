/// Draws what ROS sees (`~view/image_raw`) on a thread of its own, with a camera, a size and a
/// renderer of its own: a recording or RViz's overlay must not jump when somebody on the page picks
/// another camera, and neither stream of pictures waits for the other. Nothing is drawn, and no
/// renderer made, before somebody listens.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "core/scene_state.h"
#include "render/renderer.h"
#include "server/picture/backend.h"
#include "server/picture/camera_man.h"
#include "server/ros/bridge.h"

namespace kinescope::app {

struct ViewSettings {
  std::string camera = "three_quarter";
  int width = 1280;
  int height = 720;
  double rate_hz = 30;          // at most
  BackendOptions backend = {};  // that the process draws with; not "auto"
};

struct ViewStatus {
  int listeners = 0;
  std::uint64_t drawn = 0;
  double draw_millis = 0;  // of the last one, drawn, read back and sent
  std::string last_error;  // "" when the last picture went well
  bool hangs = false;      // the driver has not come back; last_error says from what
};

/// The pinhole camera that `camera` is, for a picture of `height_px`; how it lies in the world is
/// REP 103's: z forward, x to the right, y down.
struct Pinhole {
  urdf::Pose world_from_optical;
  double focal_px = 0;
};
Pinhole PinholeOf(const render::Camera& camera, int height_px);

class ViewLoop {
 public:
  using Send = std::function<void(const ros_bridge::ViewPicture&)>;

  /// `send` gets every picture, on the drawing thread.
  /// @throws UsageError for a camera that does not exist.
  ViewLoop(const ViewSettings& settings, std::shared_ptr<const SceneState> first, Send send);
  /// Ends the process (exit code 2) when the driver hangs and so the thread cannot be joined.
  ~ViewLoop();
  ViewLoop(const ViewLoop&) = delete;
  ViewLoop& operator=(const ViewLoop&) = delete;

  // Any thread; they never wait for drawing.
  void OnState(std::shared_ptr<const SceneState> state);
  /// Whoever comes gets a picture at once, also of a scene in which nothing moves.
  void SetListeners(int count);
  ViewStatus status() const;

 private:
  void Run();
  void Draw(const SceneState& state);
  void OnHang(const std::string& what);

  const ViewSettings settings_;
  const Send send_;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  // Guarded by mutex_:
  std::shared_ptr<const SceneState> state_;
  bool is_due_ = false;  // the newest state, or a listener, has not been served
  bool stop_ = false;
  ViewStatus status_;
  // Of the drawing thread:
  std::unique_ptr<render::Renderer> renderer_;  // null before the first listener
  CameraMan camera_;
  render::Image image_;

  std::thread thread_;  // last: it uses all of the above
};

}  // namespace kinescope::app
