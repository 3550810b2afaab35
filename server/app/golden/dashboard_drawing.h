/// Draws the page of this program as it shows a moment of a recording: starts its server beside it,
/// which reads the recording up to the moment and stops there (`serve --stop_at`).
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "server/app/golden/page_drawing.h"

namespace kinescope::app {

struct DashboardSpec {
  std::string source;  // a recording, or demo:MOTION
  double time = 0;     // s after the first sample
  /// Of the address (docs/page.md): "view=wall&tab=plots". Without `at`.
  std::string query;
  std::vector<std::string>
      options;  // of `serve`, such as "--figure=skin"; files with their whole path
  int width_px = 1440, height_px = 900;
  bool is_dark = false;
  std::chrono::milliseconds limit = std::chrono::seconds(120);  // for server and page, each
  std::filesystem::path chromium;                               // ""; FindChromium()
  std::filesystem::path program;                                // ""; the one that has `serve`
};

/// Two drawings of the same moment by the same program are the same, byte by byte.
/// @throws std::runtime_error as DrawPage(), and with what the server said if it does not start or
/// the recording ends before `time`.
PageDrawing DrawDashboard(const DashboardSpec& spec);

}  // namespace kinescope::app
