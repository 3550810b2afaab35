/// Runs `serve` and `bridge`: reads a source and passes every state on to ROS, the page and the
/// pictures.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/playback.h"
#include "core/scene_state.h"
#include "core/source.h"
#include "core/system/latest.h"
#include "server/alarms/alarms.h"
#include "server/alarms/webhook.h"
#include "server/app/serve/camera_files.h"
#include "server/app/serve/change_mailbox.h"
#include "server/app/serve/clip_maker.h"
#include "server/app/serve/control_desk.h"
#include "server/app/serve/crowd_warning.h"
#include "server/app/serve/hand_load_log.h"
#include "server/app/serve/hand_load_mailbox.h"
#include "server/app/serve/live_pictures.h"
#include "server/app/serve/liveness_log.h"
#include "server/app/serve/missing_pose_warning.h"
#include "server/app/serve/operator_log.h"
#include "server/app/serve/overload.h"
#include "server/app/serve/ros_camera_loop.h"
#include "server/app/serve/ros_desk.h"
#include "server/app/serve/ros_news.h"
#include "server/app/serve/serve_config.h"
#include "server/app/serve/stream_health.h"
#include "server/app/serve/surroundings_loop.h"
#include "server/history/history.h"
#include "server/http/mesh_server.h"
#include "server/http/server.h"
#include "server/marks/mark_book.h"
#include "server/picture/ghost_pose.h"
#include "server/recording/folder.h"
#include "server/recording/raw_recorder.h"
#include "server/ros/bridge.h"
#include "server/scene/scene_builder.h"
#include "server/source/recording_length.h"

namespace kinescope::app {

/// Create, run and destroy it on one thread, the reading thread.
class Server {
 public:
  /// When it returns, the first picture is rendered and the page can be opened.
  /// @throws SourceError, UsageError or render::RenderError of the part that cannot start.
  explicit Server(const ServeConfig& config);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Returns on Ctrl-C, when ROS requests the shutdown, or at the end of the source if there is no
  /// page.
  void Run();

 private:
  void StartRos(const ServeConfig& config);
  int ServeMeshes(const std::string& set, const std::shared_ptr<const MeshFiles>& files);
  void StartPictures(const ServeConfig& config);
  void StartControls(const ServeConfig& config);
  void StartPage(const ServeConfig& config);
  void OnState(const std::shared_ptr<SceneState>& state);
  void AddGhosts(SceneState& state) const;
  void OnTime(std::int64_t now_nanos);  // between polls
  void LogPassed(const SourceCounters& counters, std::int64_t now_nanos);
  void UpdatePlayback(bool has_ended);
  void LogStop(const Playback& playback) const;
  void OnAlarm(const alarms::Alarm& alarm, alarms::Change change) const;
  std::string Diagnostics() const;  // on the page's thread

  const std::int64_t start_nanos_;
  std::unique_ptr<http::Listener> listener_;  // before everything that takes time; until the page
                                              // has it
  const recording::Folder recordings_;
  const std::unique_ptr<recording::RawRecorder> recorder_;  // null: no live stream, or no page
  const std::unique_ptr<Source> source_;
  // Between threads:
  Latest<SceneState> states_;        // reading thread -> page
  Latest<SourceCounters> counters_;  // reading thread -> page
  Latest<Playback> playback_;        // reading thread -> page; null: live
  Latest<StreamHealth> stream_;      // reading thread -> page
  Latest<http::Picture> pictures_;   // drawing thread -> page
  CameraFiles camera_files_;
  Latest<http::Surroundings> surroundings_made_;     // its own thread -> page
  HandLoadMailbox hand_loads_;                       // page -> reading thread
  ChangeMailbox changes_;                            // page -> reading thread
  const std::unique_ptr<history::History> history_;  // reading thread -> page; null: off
  const std::unique_ptr<marks::MarkBook> marks_;     // page's thread; null: off
  const std::unique_ptr<alarms::Webhook> webhook_;   // both threads; null: off
  alarms::Alarms alarms_;                            // both threads
  Overload overload_;                                // its count: reading thread -> page
  // Used by the reading thread only:
  const bool is_recording_;                        // else live, or the built-in subject
  const bool stops_;                               // at a moment
  const std::unique_ptr<RecordingLength> length_;  // null: it cannot be found
  LivenessLog liveness_log_;
  MissingPoseWarning missing_pose_warning_;
  bool has_shown_others_ = false;  // a bag or a graph without people
  CrowdWarning crowd_warning_;
  StreamHealthMeter stream_meter_;
  const std::int64_t start_at_;        // of a recording, ns after its first sample
  std::int64_t passed_due_nanos_ = 0;  // when to tell next how far it has been passed over
  std::int64_t counters_due_nanos_ = 0;
  SceneBuilder builder_;
  const GhostPose ghost_;
  OperatorLog bridge_log_{nullptr, states_};
  std::unique_ptr<HandLoadLog> bridge_loads_;  // of a bridge; of a page the desk has one
  // Outputs, null if off; each uses only members above it.
  std::unique_ptr<LivePictures> live_pictures_;
  std::unique_ptr<http::MeshServer> meshes_;  // made by a thread of ros_, when it needs one
  RosDesk ros_desk_;
  std::unique_ptr<ros_bridge::RosBridge> ros_;
  std::unique_ptr<RosNews> ros_news_;  // with ros_
  std::unique_ptr<RosCameraLoop> ros_camera_;
  std::unique_ptr<ClipMaker> clips_;
  std::unique_ptr<ControlDesk> desk_;               // the page's thread
  std::unique_ptr<SurroundingsLoop> surroundings_;  // with page_
  std::optional<http::HttpServer> page_;
};

}  // namespace kinescope::app
