/// Renders the ROS view (`~view/image_raw`) on its own thread, with its own camera, size and
/// renderer. So a recording or an RViz overlay does not jump when a viewer of the page selects
/// another camera, and neither picture stream waits for the other. It renders only while it has
/// subscribers, and makes no renderer before the first one.
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
#include "server/picture/camera_controller.h"
#include "server/ros/bridge.h"

namespace kinescope::app {

struct RosCameraSettings {
  CameraChoice camera = {"three_quarter", std::nullopt, false};
  int width = 1280;
  int height = 720;
  double rate_hz = 30;          // maximum frame rate
  BackendOptions backend = {};  // the back-end of this process; not "auto"
};

struct RosCameraStatus {
  int listeners = 0;
  std::uint64_t drawn = 0;
  double draw_millis = 0;  // of the last one, rendered, read back and sent
  std::string last_error;  // "" if the last picture succeeded
  bool hangs = false;      // the driver does not respond; last_error contains the operation
};

/// `camera` as a pinhole camera for a picture of `height_px`; its axes follow REP 103: z forward, x
/// to the right, y down.
struct Pinhole {
  urdf::Pose world_from_optical;
  double focal_px = 0;
};
Pinhole PinholeOf(const render::Camera& camera, int height_px);

class RosCameraLoop {
 public:
  using Send = std::function<void(const ros_bridge::RosImage&)>;

  /// `send` receives every picture, on the rendering thread.
  /// @throws UsageError for an unknown camera.
  RosCameraLoop(const RosCameraSettings& settings, std::shared_ptr<const SceneState> first,
                Send send);
  /// Ends the process (exit code 2) if the driver does not respond, because the thread cannot be
  /// joined then.
  ~RosCameraLoop();
  RosCameraLoop(const RosCameraLoop&) = delete;
  RosCameraLoop& operator=(const RosCameraLoop&) = delete;

  // Any thread; these functions never wait for rendering.
  void OnState(std::shared_ptr<const SceneState> state);
  /// Sets the number of subscribers. A new subscriber receives a picture at once, even if the scene
  /// does not change.
  void SetListeners(int count);
  RosCameraStatus status() const;

 private:
  void Run();
  void Draw(const SceneState& state);
  void OnHang(const std::string& what);

  const RosCameraSettings settings_;
  const Send send_;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  // Guarded by mutex_:
  std::shared_ptr<const SceneState> state_;
  bool is_due_ = false;  // the newest state, or a new subscriber, has no picture yet
  bool stop_ = false;
  RosCameraStatus status_;
  // Used by the rendering thread only:
  std::unique_ptr<render::Renderer> renderer_;  // null before the first subscriber
  CameraController camera_;
  render::Image image_;

  std::thread thread_;  // last: it uses all other members
};

}  // namespace kinescope::app
