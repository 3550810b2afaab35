#include "server/app/serve/server.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <thread>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/stop_signal.h"
#include "server/app/serve/diagnostics.h"
#include "server/app/serve/input_merger.h"
#include "server/source/open_source.h"

namespace kinescope::app {
namespace {

// Longest wait for samples; it limits how soon Ctrl-C and staleness are noticed.
constexpr std::chrono::milliseconds kPollTimeout(50);
constexpr std::int64_t kCountersPeriodNanos = 500'000'000;

void LogReceiveBuffer(const Source& source) {
  const auto transport = source.counters().transport;
  const auto buffer = transport.find("receive_buffer_bytes");
  if (buffer == transport.end()) return;
  spdlog::info("listening at {}, receive buffer {:.1f} MB", source.description(),
               static_cast<double>(buffer->second) * 1e-6);
}

// Of a part that may be off.
template <class Part>
auto StatusOf(const std::unique_ptr<Part>& part) {
  return part ? std::optional(part->status()) : std::nullopt;
}

}  // namespace

Server::Server(const ServeConfig& config)
    : start_nanos_(MonotonicNanos()),
      source_(OpenAtTrueRate(config.source_url, config.loop, config.source)),
      builder_(config.scene, source_->description(), source_->nominal_rate_hz(),
               [this](const std::shared_ptr<const SceneState>& state) { OnState(state); }) {
  for (const std::string& note : config.notes) spdlog::info("{}", note);
  if (config.ros) StartRos(*config.ros, config.ros_mode);
  builder_.Start();  // the first state; pictures and page need one
  if (config.pictures) StartPictures(config);
  if (config.page) StartPage(*config.page);
}

void Server::StartRos(ros_bridge::BridgeConfig config, ros_bridge::RosMode mode) {
  initial_model_ = builder_.InitialModel();
  if (initial_model_->mesh_files) initial_model_->mesh_files->Provide();
  config.initial_urdf = initial_model_->urdf_xml;
  ros_ = ros_bridge::MakeRosBridge(config, mode);
}

void Server::StartPictures(const ServeConfig& config) {
  const RendererFactory make_renderer = RenderersOf(config.backend);
  live_pictures_ =
      std::make_unique<LivePictures>(*config.pictures, make_renderer, states_.Get(), pictures_);
  spdlog::info("first picture {:.2f} s after start, rendered by {}",
               Secs(MonotonicNanos() - start_nanos_), live_pictures_->status().renderer.renderer);
  if (!config.ros_camera) return;
  ros_camera_ = std::make_unique<RosCameraLoop>(
      *config.ros_camera, make_renderer, states_.Get(),
      [this](const ros_bridge::RosImage& image) { ros_->PublishView(image); });
}

void Server::StartPage(http::HttpConfig config) {
  config.set_hand_load = [this](int character, const HandLoad& load) {
    return hand_loads_.Put(character, load);
  };
  page_.emplace(config, states_, pictures_, live_pictures_.get(), [this] { return Diagnostics(); });
  spdlog::info("page at {}", page_->url());
}

void Server::OnState(const std::shared_ptr<const SceneState>& state) {
  if (ros_) ros_->Publish(*state);
  states_.Publish(state);
  if (live_pictures_) live_pictures_->OnState(state);
  if (ros_camera_) ros_camera_->OnState(state);
  liveness_log_.OnState(*state);
}

std::string Server::Diagnostics() const {
  return DiagnosticsJson(states_.Get(), counters_.Get(), StatusOf(ros_), StatusOf(live_pictures_),
                         StatusOf(ros_camera_));
}

void Server::Run() {
  LogReceiveBuffer(*source_);
  InputMerger inputs(builder_, hand_loads_, ros_.get(), [this](int count) {
    if (ros_camera_) ros_camera_->SetSubscribers(count);
  });
  while (!StopRequested()) {
    const Source::State state = source_->Poll(kPollTimeout, inputs);
    inputs.TakeInputs();
    OnTime(MonotonicNanos());
    if (ros_ && ros_->status().shutdown_requested) {
      spdlog::info("shut down through ROS");
      break;
    }
    if (state != Source::State::kEnded) continue;
    if (!page_) break;
    std::this_thread::sleep_for(kPollTimeout);  // the page stays up
  }
  spdlog::info("stopping");
}

void Server::OnTime(std::int64_t now_nanos) {
  builder_.Tick(now_nanos);
  if (now_nanos < counters_due_nanos_) return;
  counters_due_nanos_ = now_nanos + kCountersPeriodNanos;
  const auto counters = std::make_shared<const SourceCounters>(source_->counters());
  counters_.Publish(counters);
  missing_pose_warning_.OnCounters(*counters, source_->description(), now_nanos);
}

}  // namespace kinescope::app
