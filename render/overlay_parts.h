/// Names and defaults of the overlays: one line per overlay, from which the option --overlay, its
/// help and its errors are made. overlay.cc paints them.
#pragma once

#include <array>

namespace kinescope::render {

/// The overlays, one by one; PictureSpec::overlays switches all of them.
struct OverlayParts {
  bool title = true;
  bool status = true;       // status indicator: live, recorded or stale, and the sample rate
  bool legend = true;       // with units
  bool time = true;         // time code and sample number
  bool names = true;        // of several people, frames, placeholder boxes
  bool banner = true;       // "STALE", "NO DATA"
  bool scale = false;       // scale bar, true at the depth of the camera's target
  bool frame_code = false;  // machine-readable: sample and time (frame_code.h)
  bool plot = false;        // PictureSpec::load_curves
  bool marks = true;        // PictureSpec::marks
  bool images = true;       // SceneState::images
};

struct OverlayInfo {
  const char* name;  // as in the option --overlay
  bool OverlayParts::*part;
};

inline constexpr std::array<OverlayInfo, 11> kOverlays = {{
    {"title", &OverlayParts::title},
    {"status", &OverlayParts::status},
    {"legend", &OverlayParts::legend},
    {"time", &OverlayParts::time},
    {"names", &OverlayParts::names},
    {"banner", &OverlayParts::banner},
    {"scale", &OverlayParts::scale},
    {"frame_code", &OverlayParts::frame_code},
    {"plot", &OverlayParts::plot},
    {"marks", &OverlayParts::marks},
    {"images", &OverlayParts::images},
}};

}  // namespace kinescope::render
