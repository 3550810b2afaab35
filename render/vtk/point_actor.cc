#include "render/vtk/point_actor.h"

#include <vtkActor.h>

#include <utility>

namespace kinescope::render {
namespace {

constexpr float kInMetres = 0, kInPixels = 1;

// The place of a corner is that on the square, right and up, as the camera has them, and its normal
// the place of the point: VTK leaves out triangles whose corners are all at one place. The
// third number of the place says whether the square is measured in metres or in pixels.
constexpr char kPlaceOfCorner[] = R"(
  vec3 right = vec3(normalMatrix[0][0], normalMatrix[1][0], normalMatrix[2][0]);
  vec3 up = vec3(normalMatrix[0][1], normalMatrix[1][1], normalMatrix[2][1]);
  if (vertexMC.z > 0.5) {  // pixels
    gl_Position = MCDCMatrix * vec4(normalMC, 1.0);
    gl_Position.xy += vertexMC.xy * clipPerPixel * gl_Position.w;
  } else {
    gl_Position = MCDCMatrix * vec4(normalMC + right * vertexMC.x + up * vertexMC.y, 1.0);
  }
)";

}  // namespace

PointActor::PointActor(bool is_blended)
    : UnlitActor(is_blended, kPlaceOfCorner, ShadedActor::AttributesOfMesh()) {}

void PointActor::SetPoints(const std::vector<MarkerPoints>& all) {
  urdf::Mesh squares;
  Clear();
  for (const MarkerPoints& points : all) {
    if (points.is_blended != is_blended_) continue;
    const float unit = points.is_in_pixels ? kInPixels : kInMetres;
    const float right = 0.5f * points.size.x(), up = 0.5f * points.size.y();
    const int part = AddPart(points.name);
    for (std::size_t i = 0; i < points.positions.size(); ++i) {
      const std::size_t first = squares.positions.size();
      for (const auto& [x, y] : {std::pair(-right, -up), {right, -up}, {right, up}, {-right, up}}) {
        squares.AddVertex({x, y, unit}, points.positions[i]);
      }
      squares.Paint(first, points.colors[i], part);
      CloseSquare(squares);
    }
  }
  if (squares.triangles.empty()) return;
  actor()->SetVisibility(true);
  shaded_.SetMesh(squares);
}

}  // namespace kinescope::render
