#include "server/app/serve/picture_loop.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/errors.h"
#include "render/camera.h"
#include "render/png_file.h"
#include "render/watchdog.h"

namespace kinescope::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kJpegQuality = 85;
constexpr std::size_t kMostSnapshots = 16;  // waiting; more would be a client that misbehaves

double MillisSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

bool IsCamera(const std::string& name) {
  const auto& names = render::CameraNames();
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

PictureLoop::PictureLoop(const PictureOptions& options, std::shared_ptr<const SceneState> first,
                         Latest<http::Picture>& pictures)
    : options_(options),
      pictures_(pictures),
      state_(std::move(first)),
      camera_(options.camera.text) {
  const CameraController probe(options_.camera, options_.moves);  // throws for what does not exist
  std::promise<void> started;
  std::future<void> has_started = started.get_future();
  thread_ = std::thread(&PictureLoop::Run, this, std::move(started));
  try {
    has_started.get();
  } catch (...) {
    thread_.join();
    throw;
  }
}

PictureLoop::~PictureLoop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
    if (status_.hangs)
      render::EndProcess("stopped without a clean shutdown: " + status_.last_error);
  }
  wake_.notify_all();
  thread_.join();
}

void PictureLoop::OnState(std::shared_ptr<const SceneState> state) {
  bool wake = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    state_ = std::move(state);
    live_is_due_ = true;
    wake = viewers_ > 0;
  }
  if (wake) wake_.notify_one();
}

void PictureLoop::SetViewers(int count) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (count > viewers_) live_is_due_ = true;  // the new one wants to see something now
    viewers_ = count;
  }
  wake_.notify_one();
}

bool PictureLoop::SetCamera(const std::string& camera) {
  if (!IsCamera(camera)) return false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    camera_ = camera;
    live_is_due_ = true;
  }
  wake_.notify_one();
  return true;
}

std::vector<std::uint8_t> PictureLoop::SnapshotPng(const std::string& camera, int width,
                                                   int height) {
  auto snapshot = std::make_unique<Snapshot>();
  std::future<std::vector<std::uint8_t>> png = snapshot->png.get_future();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (status_.hangs) throw std::runtime_error(status_.last_error);
    if (snapshots_.size() >= kMostSnapshots) {
      throw std::runtime_error("too many requests are waiting for a picture; try again later");
    }
    snapshot->camera = camera.empty() ? camera_ : camera;
    snapshot->width = width;
    snapshot->height = height;
    snapshots_.push_back(std::move(snapshot));
  }
  wake_.notify_one();
  return png.get();
}

PictureStatus PictureLoop::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return status_;
}

void PictureLoop::DrawLive(render::Renderer& renderer, const SceneState& state,
                           const std::string& camera) {
  const auto start = Clock::now();
  const render::View view{options_.width, options_.height, 1, "", true};
  if (!live_camera_ || camera != live_camera_name_)
    live_camera_.emplace(ParseCamera(camera), options_.moves);
  live_camera_name_ = camera;
  const double aspect = static_cast<double>(view.width) / view.height;
  renderer.RenderInto(live_image_, state, live_camera_->Aim(state, aspect), view);
  const double draw_millis = MillisSince(start);
  const auto encode_start = Clock::now();
  auto picture = std::make_shared<http::Picture>();
  picture->jpeg = render::EncodeJpeg(live_image_, kJpegQuality);
  picture->state_number = state.number;
  picture->arrival_nanos = state.arrival_nanos;
  pictures_.Publish(std::move(picture));

  const std::lock_guard<std::mutex> lock(mutex_);
  OnDrawn(renderer);
  status_.draw_millis = draw_millis;
  status_.encode_millis = MillisSince(encode_start);
  status_.last_error.clear();
}

// Locked by the caller.
void PictureLoop::OnDrawn(render::Renderer& renderer) {
  ++status_.drawn;
  status_.problems = renderer.problems();
  if (!status_.hangs) return;
  status_.hangs = false;
  status_.last_error.clear();
  spdlog::warn("picture: the graphics driver responds again");
}

void PictureLoop::OnHang(const std::string& what) {
  std::vector<std::unique_ptr<Snapshot>> unanswered;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    // Nobody is there yet, or any more, who could do without pictures.
    if (stop_ || !has_started_) render::EndProcess(what);
    spdlog::error("picture: {}", what);
    status_.hangs = true;
    status_.last_error = what;
    if (in_hand_) unanswered.push_back(std::move(in_hand_));
    for (auto& waiting : snapshots_) unanswered.push_back(std::move(waiting));
    snapshots_.clear();
  }
  for (auto& snapshot : unanswered) {
    snapshot->png.set_exception(std::make_exception_ptr(std::runtime_error(what)));
  }
}

void PictureLoop::DrawSnapshot(render::Renderer& renderer, const SceneState& state) {
  std::string camera;
  render::View view;
  const auto take = [&] {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::move(in_hand_);
  };
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    camera = in_hand_->camera;
    view = {in_hand_->width, in_hand_->height, 2, "", true};
  }
  try {
    const double aspect = static_cast<double>(view.width) / view.height;
    const render::Image image = renderer.Render(
        state, CameraController(ParseCamera(camera), {}).Only(state, 0, aspect), view);
    std::vector<std::uint8_t> png = render::EncodePng(image);
    {  // before the picture goes out: whoever has it may ask what it lacks
      const std::lock_guard<std::mutex> lock(mutex_);
      OnDrawn(renderer);
    }
    if (const auto snapshot = take()) snapshot->png.set_value(std::move(png));
  } catch (...) {
    if (const auto snapshot = take()) snapshot->png.set_exception(std::current_exception());
  }
}

void PictureLoop::Run(std::promise<void> started) {
  std::unique_ptr<render::Renderer> renderer;
  try {
    const BackendChoice choice = ChooseBackend(options_.backend);
    if (!choice.note.empty()) spdlog::warn("pictures: {}", choice.note);
    renderer =
        StartRenderer(options_.backend, choice, [this](const std::string& what) { OnHang(what); });
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      status_.renderer = renderer->info();
    }
    DrawLive(*renderer, *state_, camera_);  // so that the first viewer sees a picture at once
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      has_started_ = true;
    }
    started.set_value();
  } catch (...) {
    started.set_exception(std::current_exception());
    return;
  }

  const auto period = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(1.0 / options_.rate_hz));
  Clock::time_point next_live = Clock::now();
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    const auto live_wanted = [&] { return viewers_ > 0 && live_is_due_; };
    const auto something = [&] { return stop_ || !snapshots_.empty() || live_wanted(); };
    wake_.wait(lock, something);
    if (!stop_ && snapshots_.empty() && Clock::now() < next_live) {
      wake_.wait_until(lock, next_live, [&] { return stop_ || !snapshots_.empty(); });
    }
    if (stop_) break;
    const std::shared_ptr<const SceneState> state = state_;
    const std::string camera = camera_;
    if (!snapshots_.empty()) {
      in_hand_ = std::move(snapshots_.front());
      snapshots_.pop_front();
    } else if (!live_wanted()) {
      continue;
    } else {
      live_is_due_ = false;
      next_live = std::max(next_live + period, Clock::now());
    }
    const bool is_snapshot = in_hand_ != nullptr;
    lock.unlock();
    if (is_snapshot) {
      DrawSnapshot(*renderer, *state);
      lock.lock();
      continue;
    }
    std::string error;
    try {
      DrawLive(*renderer, *state, camera);
    } catch (const std::exception& failure) {
      error = failure.what();
    }
    lock.lock();
    if (!error.empty() && status_.last_error != error) spdlog::error("picture: {}", error);
    if (!error.empty()) status_.last_error = error;
  }
  for (auto& waiting : snapshots_) {
    waiting->png.set_exception(
        std::make_exception_ptr(std::runtime_error("the server is shutting down")));
  }
}

}  // namespace kinescope::app
