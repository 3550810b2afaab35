/// How a picture is to look, as every command that draws asks for it.
#pragma once

#include <string>
#include <vector>

#include "render/renderer.h"
#include "server/picture/camera_man.h"

namespace kinescope::app {

/// "frames,axes,scale": what is shown by default, or is not (look_options.cc).
std::string PartNames(bool by_default);

struct ViewOptions {
  std::string size = "1280x720";  // px
  std::string camera = "three_quarter";
  std::string views;
  CameraOptions moves;
  int supersample = 2;  // 1, 2 or 4 times as many pixels each way
  std::string title;
  std::string overlay;
  std::string plot;
  bool no_overlays = false;
  std::string theme = "light";
  std::string background = "theme";  // or sRGB, #RRGGBB
  std::string floor = "on";
  std::string show, hide;
  std::string trail;
  double trail_secs = 2;           // s
  std::string ghost;               // FILE@SECS: s after the recording's start
  double ghost_opacity = 0.35;     // 0..1
  std::vector<std::string> robot;  // FILE@X,Y,YAW: world, m and degrees

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
    option("theme", theme, "light or dark");
    option("background", background,
           "theme, white, black, #RRGGBB, or transparent (PNG with alpha, soft edges too)");
    option("floor", floor, "on or off");
    option("show", show, "beside what is shown: " + PartNames(false) + "; commas between");
    option("hide", hide, "of what is shown: " + PartNames(true));
    option("trail", trail, "where something has been: com or segments, such as com,right_hand");
    option("trail_secs", trail_secs, "so much of the past, s");
    option("ghost", ghost, "a second body to compare with: n_pose, t_pose or FILE@SECS");
    option("ghost_opacity", ghost_opacity, "0 to 1");
    option("robot", robot,
           "FILE.urdf or FILE.urdf@X,Y,YAW (m and degrees): a robot beside the people, on the "
           "floor; may be said several times");
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
