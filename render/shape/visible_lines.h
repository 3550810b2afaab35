/// Which parts of lines in space a picture shows, judged by the depth that was drawn. One thread.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "render/camera/camera.h"
#include "render/image/tile.h"
#include "render/line_drawing.h"
#include "render/shape/surface_lines.h"

namespace kinescope::render {

/// A line of a drawing in space, world, m.
struct SpaceLine {
  SurfaceLine line;
  LineKind kind = LineKind::kOutline;
};

class VisibleLines {
 public:
  /// For a picture of `width` x `height` px.
  VisibleLines(const std::vector<SpaceLine>& lines, const Camera& camera, int width, int height);
  bool is_empty() const { return tracks_.empty(); }

  /// `depth`: of one part of the picture, 0 (near) to 1 (far), `supersample` samples per pixel each
  /// way, row by row from below, as OpenGL has it. Parts may come in any order.
  void Judge(const Tile& part, int supersample, const std::vector<float>& depth);

  /// What is seen, once all parts have been judged; px of the picture.
  std::vector<DrawnLine> Take() const;

 private:
  struct Sample {
    double x, y;     // px, y downwards
    double depth_m;  // along the view axis
    bool is_seen = false;
  };
  struct Track {
    std::vector<Sample> samples;
    LineKind kind;
    bool is_loop;
    double smallest = 0;  // px: a part that does not reach as far is left out
    double beside = 0;    // px: as far next to the line, a surface may be behind it
    std::size_t gap = 0;  // samples: a part that is hidden for less is seen
    double shortest = 0;  // px: a shorter part is left out
  };
  Camera camera_;
  std::vector<Track> tracks_;
};

}  // namespace kinescope::render
