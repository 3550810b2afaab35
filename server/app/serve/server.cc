#include "server/app/serve/server.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <filesystem>
#include <system_error>
#include <thread>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "core/system/json_text.h"
#include "core/system/stop_signal.h"
#include "server/alarms/alarm_json.h"
#include "server/app/serve/change_notes.h"
#include "server/app/serve/diagnostics.h"
#include "server/app/serve/input_merger.h"
#include "server/http/answer.h"
#include "server/marks/mark_json.h"
#include "server/picture/standing_robots.h"
#include "server/ros/source/graph_source.h"
#include "server/source/open_source.h"

namespace kinescope::app {
namespace {

// Longest wait for samples; it limits how soon Ctrl-C and staleness are noticed.
constexpr std::chrono::milliseconds kPollTimeout(50);
constexpr std::int64_t kCountersPeriodNanos = 500'000'000;

void LogListening(const Source& source, const std::string& reach) {
  if (reach.empty()) return;
  const auto transport = source.counters().transport;
  const auto buffer = transport.find("receive_buffer_bytes");
  const std::uint64_t bytes = buffer == transport.end() ? 0 : buffer->second;
  spdlog::info("listening at {}: {}; receive buffer {:.1f} MB", source.description(), reach,
               static_cast<double>(bytes) * 1e-6);
}

// The motion of the built-in subject is made, not recorded.
bool IsFile(const ServeConfig& config) {
  return KindOfSource(config.source_url) == SourceKind::kFile;
}

std::unique_ptr<Source> SourceOf(const ServeConfig& config, mvn::DatagramSink* tap) {
  SourceSettings settings = config.source;
  settings.tap = tap;
  if (config.stop_at) return OpenUpTo(config.source_url, *config.stop_at, settings);
  return OpenAtTrueRate(config.source_url, config.loop, settings, config.start_at);
}

// Null: nothing can be recorded.
std::unique_ptr<recording::RawRecorder> RecorderOf(const ServeConfig& config,
                                                   const recording::Folder& folder) {
  const SourceKind kind = KindOfSource(config.source_url);
  const bool has_datagrams = kind == SourceKind::kUdp || kind == SourceKind::kTcp;
  if (!config.page || !has_datagrams) return nullptr;
  return std::make_unique<recording::RawRecorder>(folder);
}

std::unique_ptr<alarms::Webhook> WebhookOf(const ServeConfig& config) {
  if (config.alarms.webhook.empty()) return nullptr;
  alarms::Webhook::Settings settings;
  settings.url = config.alarms.webhook;
  settings.warn = [](const std::string& line) { spdlog::warn("{}", line); };
  return std::make_unique<alarms::Webhook>(std::move(settings));
}

// Null for what cannot be read twice: a pipe.
std::unique_ptr<RecordingLength> LengthOf(const ServeConfig& config) {
  std::error_code ignored;
  if (!IsFile(config) || !std::filesystem::is_regular_file(config.source_url, ignored)) {
    return nullptr;
  }
  return std::make_unique<RecordingLength>(
      [url = config.source_url, settings = config.source] { return OpenSource(url, settings); });
}

// With the token of `role`, whole if `shows_token`. `how_to_see`: command that prints it, or "".
void LogPage(const char* what, const http::HttpServer& page, http::Role role, bool shows_token,
             const std::string& how_to_see) {
  const std::string url = page.url(role), shortened = page.url_for_log(role);
  const bool is_whole = shows_token || url == shortened;
  spdlog::info("{} at {}{}", what, is_whole ? url : shortened,
               is_whole             ? ""
               : how_to_see.empty() ? " (the token is shortened)"
                                    : " (the token is shortened; to see it: " + how_to_see + ")");
}

// Of a part that may be off.
template <class Part>
auto StatusOf(const std::unique_ptr<Part>& part) {
  return part ? std::optional(part->status()) : std::nullopt;
}

// Its changes are comments in what is recorded meanwhile.
std::unique_ptr<marks::MarkBook> BookOf(const ServeConfig& config,
                                        recording::RawRecorder* recorder) {
  if (!config.marks) return nullptr;
  if (recorder == nullptr) return std::make_unique<marks::MarkBook>(*config.marks);
  return std::make_unique<marks::MarkBook>(*config.marks, [recorder](const marks::Mark& mark) {
    recorder->Comment("Kinescope mark: " + JsonText(marks::ToJson(mark)));
  });
}

}  // namespace

Server::Server(const ServeConfig& config)
    : start_nanos_(MonotonicNanos()),
      listener_(config.page ? std::make_unique<http::Listener>(*config.page) : nullptr),
      recordings_(config.recordings, config.may_make_recordings),
      recorder_(RecorderOf(config, recordings_)),
      source_(SourceOf(config, recorder_.get())),
      history_(config.history
                   ? std::make_unique<history::History>(
                         *config.history, [this](SceneState& state) { AddGhosts(state); })
                   : nullptr),
      marks_(BookOf(config, recorder_.get())),
      webhook_(WebhookOf(config)),
      alarms_(
          config.alarms, IsLiveUrl(config.source_url),
          [this](const alarms::Alarm& alarm, alarms::Change change) { OnAlarm(alarm, change); }),
      overload_(/*may_skip=*/!config.ros),
      is_recording_(IsFile(config) || config.stop_at),
      stops_(config.stop_at.has_value()),
      length_(LengthOf(config)),
      start_at_(config.start_at),
      builder_(config.scene, source_->description(), source_->nominal_rate_hz(),
               [this](const std::shared_ptr<SceneState>& state) { OnState(state); }),
      ghost_(config.ghost, config.ghost_opacity, config.scene) {
  for (const std::string& note : config.notes) spdlog::info("{}", note);
  LogListening(*source_, config.source_reach);
  if (marks_ && marks_->unread_lines() > 0) {
    spdlog::warn("{}: {} lines are no marks; they stay in the file", marks_->file().string(),
                 marks_->unread_lines());
  }
  if (config.ros) StartRos(config);
  builder_.SetRobots(ReadStandingRobots(config.robots, config.backend));
  builder_.Start();  // the first state; pictures and page need one
  if (config.pictures) StartPictures(config);
  if (config.page) {
    StartControls(config);
    StartPage(config);
  } else {
    bridge_loads_ = std::make_unique<HandLoadLog>(bridge_log_, config.scene.loads.hands);
  }
  ros_desk_.Open({states_, builder_.InitialModel(), changes_, live_pictures_.get(),
                  page_ ? &*page_ : nullptr, desk_.get(), recordings_});
  listener_.reset();
}

Server::~Server() {
  ros_desk_.Close();
  if (surroundings_) surroundings_->End();  // it asks the page for its viewers
}

void Server::StartRos(const ServeConfig& config) {
  ros_bridge::BridgeConfig bridge = *config.ros;
  // A graph may be one of robots alone, whose description RViz looks for under the usual name.
  if (!ros_bridge::IsGraphUrl(config.source_url)) bridge.initial_model = builder_.InitialModel();
  bridge.serve_meshes = [this](const std::string& set, const auto& files) {
    return ServeMeshes(set, files);
  };
  bridge.settings = {[this] { return ros_desk_.Settings(); },
                     [this](const auto& wanted) { return ros_desk_.Change(wanted); },
                     {}};
  if (config.page && config.pictures) {
    for (const http::CameraView& camera : config.page->cameras) {
      bridge.settings.cameras.push_back(camera.name);
    }
  }
  if (config.page) {
    bridge.orders = {[this] { return ros_desk_.Snapshot(); },
                     [this](bool run) { return ros_desk_.Record(run); }};
  }
  ros_ = ros_bridge::MakeRosBridge(bridge, config.ros_mode);
  if (!ros_) return;
  ros_news_ = std::make_unique<RosNews>(*ros_, alarms_, marks_.get(), states_, config.log);
}

int Server::ServeMeshes(const std::string& set, const std::shared_ptr<const MeshFiles>& files) {
  try {
    if (!meshes_) meshes_ = std::make_unique<http::MeshServer>();
    meshes_->Offer(set, files);
    return meshes_->port();
  } catch (const UsageError& error) {
    spdlog::warn("RViz on other computers will not see the body's meshes: {}", error.what());
    return 0;
  }
}

void Server::StartPictures(const ServeConfig& config) {
  render::PreferSpeed();
  const RendererFactory make_renderer = RenderersOf(config.backend);
  LivePictureSettings settings = *config.pictures;
  settings.history = history_.get();
  live_pictures_ =
      std::make_unique<LivePictures>(settings, make_renderer, states_.Get(), pictures_);
  spdlog::info("first picture {:.2f} s after start, rendered by {}",
               Secs(MonotonicNanos() - start_nanos_), live_pictures_->status().renderer.renderer);
  if (config.clips && history_) {
    clips_ = std::make_unique<ClipMaker>(*config.clips, make_renderer, *history_, marks_.get());
  }
  if (!config.ros_camera) return;
  ros_camera_ = std::make_unique<RosCameraLoop>(
      *config.ros_camera, make_renderer, states_.Get(),
      [this](const ros_bridge::RosImage& image) { ros_->PublishView(image); });
}

void Server::StartControls(const ServeConfig& config) {
  const bool is_graph = ros_bridge::IsGraphUrl(config.source_url);
  const std::string why_no_recording =
      recorder_ ? ""
                : "the source " + config.source_url +
                      (is_graph ? " is a ROS graph, which rosbag record keeps"
                                : " is not a live stream over UDP or TCP (--source)");
  const std::string why_no_clips = clips_ ? "" : history_ ? http::kNoRenderer : http::kNoHistory;
  desk_ = std::make_unique<ControlDesk>(
      DeskParts{states_, changes_, history_.get(), marks_.get(), recordings_, recorder_.get(),
                why_no_recording, clips_.get(), why_no_clips, config.page->camera,
                config.loads_options, config.clip_options, config.scene.loads.hands});
}

void Server::StartPage(const ServeConfig& config) {
  http::HttpConfig page = *config.page;
  page.set_hand_load = [this](int character, const HandLoad& load) {
    return hand_loads_.Put(character, load);
  };
  page.history = history_.get();
  page.marks = marks_.get();
  page.controls = desk_.get();
  page.alarms = &alarms_;
  page.playback = [this] { return playback_.Get(); };
  page.stream = [this] {
    const auto stream = stream_.Get();
    return stream ? StreamHealthJson(*stream) : std::string();
  };
  page.surroundings = [this] { return surroundings_made_.Get(); };
  page.former_surroundings = [this](const std::shared_ptr<const SceneState>& former) {
    return surroundings_->Of(former);
  };
  page.camera_image = [this](std::size_t number, const auto& image) {
    return camera_files_.Of(number, image);
  };
  page.warn = [](const std::string& line) { spdlog::warn("{}", line); };
  surroundings_ = std::make_unique<SurroundingsLoop>([this] { return page_->clients() > 0; },
                                                     surroundings_made_);
  page_.emplace(page, *listener_, states_, pictures_, live_pictures_.get(),
                [this] { return Diagnostics(); });
  LogPage("page", *page_, http::Role::kOperator, config.shows_token, config.how_to_see_token);
  if (page.viewer_token.empty()) return;
  LogPage("page for viewers", *page_, http::Role::kViewer, config.shows_token,
          config.how_to_see_viewer_token);
}

// What the page needs of them is where they are.
void Server::AddGhosts(SceneState& state) const {
  state.ghosts = ghost_.Make(state);
  int character = kFirstGhost;
  for (Ghost& ghost : state.ghosts) {
    ghost.person.character = character++;
    ghost.person.com.reset();
    ghost.person.cop.reset();
    ghost.person.loads.clear();
    ghost.person.forces = BodyForces();
  }
}

void Server::OnState(const std::shared_ptr<SceneState>& state) {
  state->made_nanos = source_->now_nanos();
  AddGhosts(*state);
  alarms_.OnState(*state);
  if (ros_) ros_->Publish(*state);
  states_.Publish(state);
  if (history_) history_->Add(state);
  // Samples that come at once would be left out.
  constexpr std::uint64_t kSettleEach = 100;
  if (history_ && stops_ && state->number % kSettleEach == 0) history_->Settle();
  if (live_pictures_) live_pictures_->OnState(state);
  if (ros_camera_) ros_camera_->OnState(state);
  if (surroundings_) surroundings_->OnState(state);
  liveness_log_.OnState(*state);
}

void Server::OnAlarm(const alarms::Alarm& alarm, alarms::Change change) const {
  spdlog::info("alarm {} {}: {}", alarm.rule.name, Name(change), Describe(alarm));
  if (webhook_) webhook_->Send(alarms::NewsJson(alarm, change));
  if (ros_news_) ros_news_->OnAlarm();
}

std::string Server::Diagnostics() const {
  return DiagnosticsJson(states_.Get(), counters_.Get(), StatusOf(ros_), StatusOf(live_pictures_),
                         StatusOf(ros_camera_), overload_.skipped(), history_.get(),
                         stream_.Get().get(), webhook_.get());
}

void Server::Run() {
  InputMerger inputs(
      builder_, overload_, hand_loads_, ros_.get(),
      [this](int count) {
        if (ros_camera_) ros_camera_->SetSubscribers(count);
      },
      &changes_,
      [this](int character, const HandLoad& load) {
        const std::int64_t now = source_->now_nanos();
        if (desk_) return desk_->OnRosHandLoad(character, load, now);
        const auto state = states_.Get();
        bridge_loads_->OnRos(character, NameOf(state.get(), character), load, now,
                             StatedHandLoadOf(state.get(), character));
      },
      [this](const std::string& text) { ros_news_->OnMark(text); },
      [this] { return source_->now_nanos(); });
  while (!StopRequested()) {
    const Source::State state = source_->Poll(kPollTimeout, inputs);
    inputs.TakeInputs();
    inputs.AfterPoll();
    OnTime(source_->now_nanos());
    UpdatePlayback(state == Source::State::kEnded);
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

void Server::UpdatePlayback(bool has_ended) {
  if (!is_recording_) return;
  std::optional<Playback> now = source_->playback();
  if (!now) return;
  const std::shared_ptr<const Playback> before = playback_.Get();
  if (length_ != nullptr) now->length_nanos = length_->nanos();
  if (before != nullptr) now->ended_nanos = before->ended_nanos;
  if (has_ended && !now->ended_nanos) now->ended_nanos = states_.Get()->made_nanos;
  if (before != nullptr && *before == *now) return;
  playback_.Publish(std::make_shared<const Playback>(*now));
  const bool is_complete = now->ended_nanos && (length_ == nullptr || now->length_nanos);
  if (stops_ && is_complete) LogStop(*now);
}

// Programs wait for this line: it comes when all that the page shows is there.
void Server::LogStop(const Playback& playback) const {
  const std::shared_ptr<const SceneState> state = states_.Get();
  spdlog::info("stopped at {:.3f} s, sample {}", Secs(state->stamp_nanos - playback.start_nanos),
               state->counter);
}

void Server::OnTime(std::int64_t now_nanos) {
  builder_.Tick(now_nanos);
  alarms_.OnTime(now_nanos, stream_meter_.health().recent_loss);
  if (desk_) desk_->OnTime(now_nanos);
  if (bridge_loads_) bridge_loads_->OnTime(now_nanos);
  if (ros_news_) ros_news_->OnTime(now_nanos, stream_meter_.health());
  if (now_nanos < counters_due_nanos_) return;
  counters_due_nanos_ = now_nanos + kCountersPeriodNanos;
  const auto counters = std::make_shared<const SourceCounters>(source_->counters());
  counters_.Publish(counters);
  LogPassed(*counters, now_nanos);
  stream_meter_.OnCounters(*counters, now_nanos);
  stream_.Publish(std::make_shared<const StreamHealth>(stream_meter_.health()));
  has_shown_others_ = has_shown_others_ || states_.Get()->liveness == Liveness::kNoPerson;
  if (!has_shown_others_) {
    missing_pose_warning_.OnCounters(*counters, source_->description(), now_nanos);
  }
  crowd_warning_.OnCounters(*counters);
}

// A long recording takes its time to where it begins.
void Server::LogPassed(const SourceCounters& counters, std::int64_t now_nanos) {
  constexpr std::int64_t kEveryNanos = 5 * kNanosPerSecond;
  if (counters.passed_nanos == 0 || now_nanos < passed_due_nanos_) return;
  const bool is_first = passed_due_nanos_ == 0;
  passed_due_nanos_ = now_nanos + (is_first ? kNanosPerSecond : kEveryNanos);
  if (is_first) return;  // a short one is there by then
  spdlog::info("{}: passed over {:.0f} s so far; it begins at {:.0f} s (--start_at)",
               source_->description(), Secs(counters.passed_nanos), Secs(start_at_));
}

}  // namespace kinescope::app
