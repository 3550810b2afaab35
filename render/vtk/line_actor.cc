#include "render/vtk/line_actor.h"

#include <vtkActor.h>

#include "render/vtk/float_array.h"

namespace kinescope::render {
namespace {

// The place of a corner says where it is: at the begin (0) or the end (1), on the one side (-1) or
// the other (1). Its normal is the place of its end of the line: VTK leaves out triangles with two
// corners at one place. What is behind the camera is cut off here, because the width of a line is
// across its direction on the screen.
constexpr float kCorners[4][2] = {{0, -1}, {0, 1}, {1, 1}, {1, -1}};

constexpr char kPlaceOfEnd[] = R"(
  const float nearest = 1e-3;
  vec4 own = MCDCMatrix * vec4(normalMC, 1.0);
  vec4 other = MCDCMatrix * vec4(otherEnd, 1.0);
  if (own.w < nearest && other.w > nearest) {
    own = mix(own, other, (nearest - own.w) / (other.w - own.w));
  } else if (other.w < nearest && own.w > nearest) {
    other = mix(other, own, (nearest - other.w) / (own.w - other.w));
  }
  vec2 along = (other.xy / other.w - own.xy / own.w) / clipPerPixel;
  if (vertexMC.x > 0.5) along = -along;
  float size = length(along);
  vec2 across = size > 0.0 ? vec2(-along.y, along.x) / size : vec2(0.0);
  gl_Position = own;
  gl_Position.xy += 0.5 * vertexMC.y * across * clipPerPixel * own.w;  // a pixel wide
)";

}  // namespace

LineActor::LineActor(bool is_blended)
    : UnlitActor(is_blended, kPlaceOfEnd, {{"part", 1}, {"tint", 4}, {"otherEnd", 3}}) {}

void LineActor::SetLines(const std::vector<MarkerLines>& all) {
  urdf::Mesh corners;
  std::vector<Eigen::Vector3f> others;
  Clear();
  for (const MarkerLines& lines : all) {
    if (lines.is_blended != is_blended_) continue;
    const int part = AddPart(lines.name);
    for (std::size_t i = 0; i + 1 < lines.positions.size(); i += 2) {
      for (const auto& [end, side] : kCorners) {
        const std::size_t own = end < 1 ? i : i + 1, other = end < 1 ? i + 1 : i;
        corners.AddVertex({end, side, 0}, lines.positions[own]);
        corners.Paint(corners.positions.size() - 1, lines.colors[own], part);
        others.push_back(lines.positions[other]);
      }
      CloseSquare(corners);
    }
  }
  if (corners.triangles.empty()) return;
  actor()->SetVisibility(true);
  const auto positions = ToFloatArray("position", 3, corners.positions);
  const auto normals = ToFloatArray("Normals", 3, corners.normals);
  const auto parts = ToFloatArray("part", 1, corners.parts);
  const auto tints = ToFloatArray("tint", 4, corners.colors);
  const auto ends = ToFloatArray("otherEnd", 3, others);
  shaded_.SetSurface(positions, normals, {parts, tints, ends}, corners.triangles);
}

}  // namespace kinescope::render
