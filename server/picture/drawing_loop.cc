#include "server/picture/drawing_loop.h"

#include <spdlog/spdlog.h>

#include <exception>
#include <stdexcept>
#include <utility>

#include "render/watchdog.h"

namespace kinescope::app {
namespace {

double MillisBetween(DrawingLoop::Clock::time_point from, DrawingLoop::Clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

void Dress(const DrawingSettings& settings, render::SceneLook& look) {
  settings.people.ApplyTo(look);
  if (!settings.background) return;
  look.background = settings.background;
  look.theme = render::ThemeOn(*settings.background);
}

}  // namespace

render::PictureSpec LiveView(int width, int height) {
  render::PictureSpec view{width, height, 1, "", true};
  view.look.detail = render::Detail::kBySize;
  return view;
}

DrawingLoop::DrawingLoop(DrawingSettings settings, CameraController camera,
                         RendererFactory make_renderer, std::shared_ptr<const SceneState> first,
                         Deliver deliver)
    : settings_(std::move(settings)),
      period_(std::chrono::duration_cast<Clock::duration>(
          std::chrono::duration<double>(1.0 / settings_.rate_hz))),
      make_renderer_(std::move(make_renderer)),
      deliver_(std::move(deliver)),
      state_(std::move(first)),
      camera_(std::move(camera)),
      trails_(settings_.trails),
      next_live_(Clock::time_point::min()) {
  camera_.StartTime(*state_);
  trails_.Remember(*state_);
  thread_ = std::thread(&DrawingLoop::Run, this);
}

DrawingLoop::~DrawingLoop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
    if (status_.hangs)
      render::EndProcess("stopped without a clean shutdown: " + status_.last_error);
  }
  wake_.notify_all();
  thread_.join();
}

void DrawingLoop::OnState(std::shared_ptr<const SceneState> state) {
  bool wake = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    state_ = std::move(state);
    camera_.StartTime(*state_);
    trails_.Remember(*state_);
    wake = !std::exchange(live_is_due_, true) && status_.viewers > 0;
  }
  if (wake) wake_.notify_one();
}

void DrawingLoop::SetViewers(int count) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (count > status_.viewers) live_is_due_ = true;
    status_.viewers = count;
  }
  wake_.notify_one();
}

void DrawingLoop::SetDark(bool is_dark) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    live_is_due_ = live_is_due_ || is_dark != is_dark_;
    is_dark_ = is_dark;
  }
  wake_.notify_one();
}

void DrawingLoop::SetCamera(CameraController camera) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    camera_ = std::move(camera);
    camera_.StartTime(*state_);
    live_is_due_ = true;
  }
  wake_.notify_one();
}

std::future<render::Image> DrawingLoop::Request(const render::PictureSpec& view,
                                                std::optional<CameraController> camera,
                                                std::shared_ptr<const SceneState> state) {
  return Enqueue({view, std::move(camera), nullptr, std::move(state), {}});
}

std::future<render::Image> DrawingLoop::RequestAimed(const render::PictureSpec& view, Aim aim,
                                                     std::shared_ptr<const SceneState> state) {
  return Enqueue({view, std::nullopt, std::move(aim), std::move(state), {}});
}

render::PictureSpec DrawingLoop::LiveSpec() const {
  render::PictureSpec view = LiveView(settings_.width, settings_.height);
  if (is_dark_) view.look.theme = render::Theme::kDark;
  Dress(settings_, view.look);
  view.look.trails = trails_.Make();
  view.look.ghosts = state_->ghosts;
  return view;
}

render::Camera DrawingLoop::AimLive(const render::ViewShape& shape) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return camera_.AimLive(*state_, shapes_.Of(LiveSpec(), *state_), shape);
}

render::Camera DrawingLoop::AimAlone(const SceneState& state,
                                     const render::ViewShape& shape) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return camera_.OnlyLive(state, shape);
}

std::future<render::Image> DrawingLoop::Enqueue(Order order) {
  std::future<render::Image> picture = order.picture.get_future();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (status_.hangs) throw std::runtime_error(status_.last_error);
    if (orders_.size() >= kMaxWaiting) {
      throw std::runtime_error("too many requests are waiting for a picture; try again later");
    }
    orders_.push_back(std::move(order));
  }
  wake_.notify_one();
  return picture;
}

DrawingStatus DrawingLoop::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return status_;
}

void DrawingLoop::Run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (WaitForWork(lock)) {
    if (orders_.empty()) {
      DrawLive(lock);
    } else {
      DrawOrder(lock);
    }
  }
  RefuseOrders("the server is shutting down");
  lock.unlock();
  renderer_.reset();  // on the thread that made it
}

// True when a picture is due, false at the end.
bool DrawingLoop::WaitForWork(std::unique_lock<std::mutex>& lock) {
  while (!stop_ && orders_.empty()) {
    if (status_.viewers == 0 || !live_is_due_) {
      wake_.wait(lock);
      continue;
    }
    const Clock::time_point now = settings_.now();
    if (now >= next_live_) return true;
    wake_.wait_for(lock, next_live_ - now);
  }
  return !stop_;
}

void DrawingLoop::DrawLive(std::unique_lock<std::mutex>& lock) {
  const Clock::time_point begin = settings_.now();
  live_is_due_ = false;
  // Counted from this picture, not from when it was due: then no two are closer than the period,
  // neither after a pause nor after a picture that came late.
  next_live_ = begin + period_;
  const std::shared_ptr<const SceneState> state = state_;
  const render::PictureSpec view = LiveSpec();
  const render::Camera camera = camera_.AimLive(*state, shapes_.Of(view, *state));
  lock.unlock();
  std::string error;
  Clock::time_point drawn = begin;
  try {
    StartedRenderer().RenderInto(live_image_, *state, camera, view);
    drawn = settings_.now();
    lock.lock();
    NoteDrawn();  // first: the receiver of the picture may ask what it lacks
    status_.draw_millis = MillisBetween(begin, drawn);
    lock.unlock();
    deliver_(live_image_, *state, camera);
  } catch (const std::exception& failure) {
    error = failure.what();
  }
  const Clock::time_point delivered = settings_.now();
  lock.lock();
  NoteReturn();
  if (error.empty()) {
    status_.deliver_millis = MillisBetween(drawn, delivered);
  } else if (status_.last_error != error) {
    spdlog::error("{}: {}", settings_.name, error);
  }
  status_.last_error = error;
}

void DrawingLoop::DrawOrder(std::unique_lock<std::mutex>& lock) {
  Order order = std::move(orders_.front());
  orders_.pop_front();
  in_hand_ = std::move(order.picture);
  Dress(settings_, order.view.look);
  if (!order.state) order.view.look.trails = trails_.Make();
  const std::shared_ptr<const SceneState> state = order.state ? order.state : state_;
  order.view.look.ghosts = state->ghosts;
  const render::ViewShape shape = shapes_.Of(order.view, *state);
  std::optional<render::Camera> camera;
  if (order.camera) {
    camera = order.camera->OnlyLive(*state, shape);
  } else if (!order.aim) {
    camera = camera_.AimLive(*state, shapes_.Of(LiveSpec(), *state), shape);
  }
  lock.unlock();
  render::Image image;
  std::exception_ptr failure;
  try {
    if (!camera) camera = order.aim(shape);
    image = StartedRenderer().Render(*state, *camera, order.view);
  } catch (...) {
    failure = std::current_exception();
  }
  lock.lock();
  NoteReturn();
  if (!failure) NoteDrawn();
  if (!in_hand_) return;
  std::promise<render::Image> picture = std::move(*in_hand_);
  in_hand_.reset();
  if (failure) {
    picture.set_exception(failure);
  } else {
    picture.set_value(std::move(image));
  }
}

void DrawingLoop::NoteReturn() {
  if (!std::exchange(status_.hangs, false)) return;
  status_.last_error.clear();
  spdlog::warn("{}: the graphics driver responds again", settings_.name);
}

void DrawingLoop::NoteDrawn() {
  NoteReturn();
  ++status_.drawn;
  status_.problems = renderer_->problems();
  status_.drawn_at = Clock::now();
}

void DrawingLoop::RefuseOrders(const std::string& reason) {
  const auto error = std::make_exception_ptr(std::runtime_error(reason));
  if (in_hand_) in_hand_->set_exception(error);
  in_hand_.reset();
  for (Order& order : orders_) order.picture.set_exception(error);
  orders_.clear();
}

render::Renderer& DrawingLoop::StartedRenderer() {
  if (!renderer_) {
    renderer_ = make_renderer_([this](const std::string& what) { OnHang(what); });
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.renderer = renderer_->info();
  }
  return *renderer_;
}

// The rest of the process goes on without pictures.
void DrawingLoop::OnHang(const std::string& what) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (stop_) render::EndProcess(what);
  spdlog::error("{}: {}", settings_.name, what);
  status_.hangs = true;
  status_.last_error = what;
  RefuseOrders(what);
}

}  // namespace kinescope::app
