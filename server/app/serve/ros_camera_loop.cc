#include "server/app/serve/ros_camera_loop.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <cmath>
#include <utility>

#include "render/camera.h"
#include "render/watchdog.h"

namespace kinescope::app {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

Pinhole PinholeOf(const render::Camera& camera, int height_px) {
  const Eigen::Vector3d forward = (camera.target - camera.position).normalized();
  const Eigen::Vector3d right = forward.cross(camera.up).normalized();
  Eigen::Matrix3d axes;
  axes << right, forward.cross(right), forward;
  Pinhole pinhole;
  pinhole.world_from_optical.position = camera.position;
  pinhole.world_from_optical.orientation = Eigen::Quaterniond(axes).normalized();
  pinhole.focal_px = 0.5 * height_px / std::tan(0.5 * camera.vertical_fov_rad);
  return pinhole;
}

RosCameraLoop::RosCameraLoop(const RosCameraSettings& settings,
                             std::shared_ptr<const SceneState> first, Send send)
    : settings_(settings),
      send_(std::move(send)),
      state_(std::move(first)),
      camera_(settings.camera, CameraOptions()) {
  thread_ = std::thread(&RosCameraLoop::Run, this);
}

RosCameraLoop::~RosCameraLoop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
    if (status_.hangs)
      render::EndProcess("stopped without a clean shutdown: " + status_.last_error);
  }
  wake_.notify_all();
  thread_.join();
}

void RosCameraLoop::OnState(std::shared_ptr<const SceneState> state) {
  bool wake = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    state_ = std::move(state);
    is_due_ = true;
    wake = status_.listeners > 0;
  }
  if (wake) wake_.notify_one();
}

void RosCameraLoop::SetListeners(int count) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (count > status_.listeners) is_due_ = true;
    status_.listeners = count;
  }
  wake_.notify_one();
}

RosCameraStatus RosCameraLoop::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return status_;
}

void RosCameraLoop::Draw(const SceneState& state) {
  const auto start = Clock::now();
  if (!renderer_) {
    renderer_ = StartRenderer(settings_.backend, {*settings_.backend.backend, ""},
                              [this](const std::string& what) { OnHang(what); });
  }
  const double aspect = static_cast<double>(settings_.width) / settings_.height;
  const render::Camera camera = camera_.Aim(state, aspect);
  renderer_->RenderInto(image_, state, camera, {settings_.width, settings_.height, 1, "", true});
  const Pinhole pinhole = PinholeOf(camera, settings_.height);
  send_({image_.width, image_.height, image_.rgba, state.stamp_nanos, pinhole.world_from_optical,
         pinhole.focal_px});
  const std::lock_guard<std::mutex> lock(mutex_);
  ++status_.drawn;
  status_.draw_millis = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  status_.last_error.clear();
}

// On the watchdog's thread. Robots need what else the process does: it goes on without the view.
void RosCameraLoop::OnHang(const std::string& what) {
  spdlog::error("view: {}", what);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (stop_) render::EndProcess(what);
  status_.hangs = true;
  status_.last_error = what;
}

void RosCameraLoop::Run() {
  const auto period = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(1.0 / settings_.rate_hz));
  Clock::time_point next = Clock::now();
  std::unique_lock<std::mutex> lock(mutex_);
  const auto is_wanted = [&] { return status_.listeners > 0 && is_due_; };
  while (true) {
    wake_.wait(lock, [&] { return stop_ || is_wanted(); });
    wake_.wait_until(lock, next, [&] { return stop_; });
    if (stop_) break;
    if (!is_wanted()) continue;
    is_due_ = false;
    // At even steps while they are kept; after a pause not two at once.
    next = next + period > Clock::now() ? next + period : Clock::now() + period;
    const std::shared_ptr<const SceneState> state = state_;
    lock.unlock();
    std::string error;
    try {
      Draw(*state);
    } catch (const std::exception& failure) {
      error = failure.what();
    }
    lock.lock();
    if (std::exchange(status_.hangs, false))
      spdlog::warn("view: the graphics driver responds again");
    if (error.empty() || status_.last_error == error) continue;
    spdlog::error("view: {}", error);
    status_.last_error = error;
  }
  lock.unlock();
  renderer_.reset();  // on the thread that made it
}

}  // namespace kinescope::app
