/// Converts all external markers of a scene to triangles, points, lines, texts and boxes: what
/// pictures and the page show of them. World, metres. One thread.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/scene_marker.h"
#include "render/module.h"
#include "render/shape/visual_mesh.h"

namespace kinescope::render {

/// Places of one marker with their colours.
struct MarkerPlaces {
  std::string name;  // "scan/0"
  bool is_blended = false;
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector4f> colors;  // one for each
};

/// Squares that face the viewer.
struct MarkerPoints : MarkerPlaces {
  Eigen::Vector2f size;       // width and height
  bool is_in_pixels = false;  // `size` is in pixels of the picture, not in metres
};

/// Lines of one pixel of the picture, at any distance; each has two places, also those of a strip.
struct MarkerLines : MarkerPlaces {};

/// Around a marker with triangles or points.
struct MarkerBox {
  Eigen::AlignedBox3f box;
  float around_px = 0;  // reach of the marker beyond the box on the screen, for points in pixels
};

/// With their colours; the part of a vertex is the index of its marker's name, "walls/3".
struct MarkerSurface {
  urdf::Mesh mesh;
  std::vector<std::string> names;
};

struct MarkerShapes {
  MarkerSurface ground;        // what others lie on, in the order in which it is drawn
  MarkerSurface ground_depth;  // those of it that are opaque, which hide what is behind them
  MarkerSurface solid;
  MarkerSurface blended;  // lets others shine through
  std::vector<MarkerPoints> points;
  std::vector<MarkerLines> lines;
  bool is_closed = true;  // no surface of `solid` is visible from its back
  std::vector<MarkerBox> boxes;
  std::vector<Label> labels;  // texts, and the names of missing meshes
  /// Markers that are not shown, or whose mesh is replaced by a box: one line each, with the marker
  /// and the reason. A flood of them ends with their number.
  std::vector<std::string> problems;
};

class MarkerReader {
 public:
  /// `most_triangles`: of all markers together; those beyond it are left out, and named.
  explicit MarkerReader(std::size_t most_triangles) : most_triangles_(most_triangles) {}

  MarkerShapes Read(const std::vector<std::shared_ptr<const SceneMarker>>& markers);

 private:
  void Add(const SceneMarker& marker, MarkerShapes& to);
  static void AddPoints(const SceneMarker& marker, MarkerShapes& to);
  static void AddLines(const SceneMarker& marker, MarkerShapes& to);
  void AddTo(MarkerSurface& surface, const SceneMarker& marker, MarkerShapes& to);
  void AddMesh(const SceneMarker& marker, urdf::Mesh& mesh, MarkerShapes& to);
  [[nodiscard]] bool HasRoomFor(std::size_t triangles);
  const VisualMesh& MeshOf(const std::string& uri);

  const std::size_t most_triangles_;
  std::size_t triangles_ = 0;                 // of those that are read now
  std::map<std::string, VisualMesh> meshes_;  // by URI
};

}  // namespace kinescope::render
