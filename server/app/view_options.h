/// How a picture is to look, as every command that draws asks for it.
#pragma once

#include <string>

#include "render/renderer.h"

namespace kinescope::app {

struct ViewOptions {
  std::string size = "1280x720";
  std::string camera = "three_quarter";
  int supersample = 2;
  std::string title;
  bool no_overlays = false;

  template <class Option>
  void Visit(Option&& option) {
    option("size", size, "WIDTHxHEIGHT, px");
    option("camera", camera, "front back left right top iso three_quarter");
    option("supersample", supersample, "1, 2 or 4: drawn larger, then averaged");
    option("title", title, "text in the upper left corner");
    option("no_overlays", no_overlays, "no legend, time code and title");
  }
};

/// @throws UsageError naming option, value and what was expected.
render::View ToView(const ViewOptions& options);

}  // namespace kinescope::app
