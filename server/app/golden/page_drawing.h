/// Draws a web page with Chromium: its picture, and what a person reads on it. The page is drawn
/// when it is loaded and stands still; what changes by itself says so (the attribute
/// data-changing).
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "render/image/image.h"
#include "server/app/golden/page_messages.h"

namespace kinescope::app {

struct PageSpec {
  std::string url;                       // http:, https: or file:
  std::string name;                      // in messages; "": the URL
  int width_px = 1440, height_px = 900;  // of the window, 16 to 8192
  bool is_dark = false;                  // prefers-color-scheme
  /// CSS selector; the page is ready when it finds something. "": when it is loaded.
  std::string ready_when;
  /// Time of day at which the clock of the page stands still, ms since 1970; nullopt: it goes on.
  std::optional<std::int64_t> date_millis;
  std::chrono::milliseconds limit = std::chrono::seconds(60);  // for all
  std::filesystem::path chromium;                              // ""; FindChromium()
};

struct PageDrawing {
  render::Image image;                // width_px x height_px
  std::vector<PageElement> elements;  // in the order of the document
  int content_height_px = 0;          // of the page, of which the window shows the beginning
  std::string browser;                // "Chromium 131.0.6778.85"
};

/// @throws std::runtime_error with the URL, what was wrong and what to do: there is no Chromium or
/// it has ended, the page cannot be loaded or is an error page, it is not ready or still moves
/// after `limit`, or the user stops this program.
PageDrawing DrawPage(const PageSpec& spec);

/// Whether both show the same, pixel by pixel and word by word, but for what changes by itself.
/// Else the place where they first differ: "a text: ...", "200x30 px at x 10, y 20".
std::optional<std::string> FindChange(const PageDrawing& a, const PageDrawing& b);

}  // namespace kinescope::app
