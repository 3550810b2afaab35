/// The configuration of a running `serve` or `bridge`: the options as values that its parts take.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/alarms/rule.h"
#include "server/app/log.h"
#include "server/app/serve/clip_maker.h"
#include "server/app/serve/live_pictures.h"
#include "server/app/serve/option_texts.h"
#include "server/app/serve/ros_camera_loop.h"
#include "server/app/serve/serve_options.h"
#include "server/history/history.h"
#include "server/http/server.h"
#include "server/marks/mark_book.h"
#include "server/picture/backend.h"
#include "server/picture/view_options.h"
#include "server/ros/bridge.h"
#include "server/scene/scene_builder.h"
#include "server/source/open_source.h"

namespace kinescope::app {

/// nullopt: that part is off.
struct ServeConfig {
  std::string source_url;
  std::string source_reach;  // who can send to it, for the log; "": no sender, it does not listen
  bool loop = false;
  std::int64_t start_at = 0;            // ns after the first sample; see PacedSource
  std::optional<std::int64_t> stop_at;  // ns after the first sample; see PacedSource::UpTo()
  SourceSettings source;
  SceneOptions scene;
  alarms::Rules alarms;
  ros_bridge::RosMode ros_mode = ros_bridge::RosMode::kAuto;
  std::optional<ros_bridge::BridgeConfig> ros;  // initial_model is known when the scene builder is
  BackendOptions backend;
  std::optional<LivePictureSettings> pictures;
  std::optional<RosCameraSettings> ros_camera;    // only with `pictures` and `ros`
  std::optional<history::HistoryLimits> history;  // only with `page`
  std::optional<marks::BookSettings> marks;       // only with `history`
  std::optional<http::HttpConfig> page;           // without its callbacks
  std::vector<RobotPlace> robots;
  GhostValue ghost;
  double ghost_opacity = 0;
  std::optional<ClipSettings> clips;  // only with `history` and `pictures`
  std::filesystem::path recordings;   // folder
  bool may_make_recordings = true;    // the folder
  OptionTexts loads_options;          // of the reports
  OptionTexts clip_options;           // of clips of recordings: as the live picture looks
  // Commands that print the tokens of the page, or "".
  std::string how_to_see_token, how_to_see_viewer_token;
  bool shows_token = false;        // in the log, which is a terminal and no file
  std::shared_ptr<LogTail> log;    // for /rosout; null: none
  std::vector<std::string> notes;  // parts that other options switched off, for the log
};

/// Checks all options before anything starts, also those of parts that are off; opens no source and
/// no port, but reads the files that options name, and makes a missing file of --token_file.
/// `with_page`: `serve`; else `bridge`.
/// @throws UsageError naming the option.
ServeConfig MakeServeConfig(const ServeOptions& options, bool with_page);

}  // namespace kinescope::app
