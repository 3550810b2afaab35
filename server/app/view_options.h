/// How a picture is to look, as every command that draws asks for it.
#pragma once

#include <string>
#include <vector>

#include "render/renderer.h"
#include "server/app/camera_man.h"

namespace kinescope::app {

struct ViewOptions {
  std::string size = "1280x720";
  std::string camera = "three_quarter";
  std::string views;
  CameraOptions moves;
  int supersample = 2;
  std::string title;
  std::string overlay;
  std::string plot;
  bool no_overlays = false;

  template <class Option>
  void Visit(Option&& option) {
    option("size", size, "WIDTHxHEIGHT, px");
    option("camera", camera, kCameraKinds);
    option("views", views,
           "several in one picture: named cameras with commas between, rows with /, such as "
           "front,right/top,camera (what --camera says); or 2x1, 3x1, 1x2, 2x2");
    moves.Visit(option);
    option("supersample", supersample, "1, 2 or 4: drawn larger, then averaged");
    option("title", title, "text in the upper left corner");
    option("overlay", overlay,
           "title lamp legend time names banner scale strip plot, with commas between: these; each "
           "with + or -: besides, or without; not given: all but scale, strip and plot");
    option("plot", plot, "joints with commas between, such as right_elbow,l5_s1: loads over time");
    option("no_overlays", no_overlays, "no legend, time code and title");
  }
};

/// Without cameras. @throws UsageError naming option, value and what was expected.
render::View ToView(const ViewOptions& options);

// Both: @throws UsageError as ToView.

/// "title,time", "+scale,-legend"; "" the usual ones.
render::OverlayParts ToOverlayParts(const std::string& text);

/// urdf::Joint of those that have a load. @pre text names none, one or several
std::vector<int> ToPlotJoints(const std::string& text);

/// The cameras of `views`, row by row; `columns` of all rows but a shorter last one.
struct ViewGrid {
  std::vector<std::string> cameras;
  int columns = 1;
};
ViewGrid ToViewGrid(const std::string& views);

}  // namespace kinescope::app
