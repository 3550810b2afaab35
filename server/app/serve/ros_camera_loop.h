/// Renders the pictures of the ROS camera (`~view/image_raw`) on its own thread, with its own
/// camera, size and renderer. So a recording or an RViz overlay does not jump when a viewer of the
/// page selects another camera, and neither picture stream waits for the other. It renders only
/// while it has subscribers, and makes no renderer before the first one.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "core/scene_state.h"
#include "server/picture/backend.h"
#include "server/picture/camera_controller.h"
#include "server/picture/drawing_loop.h"
#include "server/picture/people_look.h"
#include "server/ros/bridge.h"

namespace kinescope::app {

struct RosCameraSettings {
  /// In perspective, because ROS describes a pinhole camera.
  CameraController camera{{"three_quarter", std::nullopt, false}, {}};
  int width = 1280;
  int height = 720;
  double rate_hz = 30;  // maximum frame rate
  PeopleLook people = {};
  std::optional<Rgb> background = {};  // none: that of the light theme
  TrailSettings trails = {};
};

class RosCameraLoop {
 public:
  using Send = std::function<void(const ros_bridge::RosImage&)>;

  /// `send` receives every picture, on the drawing thread.
  RosCameraLoop(const RosCameraSettings& settings, RendererFactory make_renderer,
                std::shared_ptr<const SceneState> first, Send send);

  // Any thread; these functions never wait for rendering.
  void OnState(std::shared_ptr<const SceneState> state) { loop_.OnState(std::move(state)); }
  /// A new subscriber receives a picture, even if the scene does not change.
  void SetSubscribers(int count) { loop_.SetViewers(count); }
  DrawingStatus status() const { return loop_.status(); }

 private:
  DrawingLoop loop_;
};

}  // namespace kinescope::app
