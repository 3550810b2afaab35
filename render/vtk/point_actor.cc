#include "render/vtk/point_actor.h"

#include <vtkActor.h>

#include <utility>

namespace kinescope::render {
namespace {

constexpr float kInMetres = 0, kInPixels = 1;

// The place of a corner is that on the square, right and up, as the camera has them, and its normal
// the place of the point: VTK leaves out triangles whose corners are all at one place. The
// third number of the place says whether the square is measured in metres or in pixels.
ShaderText PointText() {
  ShaderText text;
  text.vertex_declarations = "out vec4 tintVS;\n";
  text.vertex = R"(
  vec3 right = vec3(normalMatrix[0][0], normalMatrix[1][0], normalMatrix[2][0]);
  vec3 up = vec3(normalMatrix[0][1], normalMatrix[1][1], normalMatrix[2][1]);
  if (vertexMC.z > 0.5) {  // pixels
    gl_Position = MCDCMatrix * vec4(normalMC, 1.0);
    gl_Position.xy += vertexMC.xy * clipPerPixel * gl_Position.w;
  } else {
    gl_Position = MCDCMatrix * vec4(normalMC + right * vertexMC.x + up * vertexMC.y, 1.0);
  }
  normalVCVSOutput = vec3(0.0, 0.0, 1.0);
  tintVS = tint;
)";
  text.fragment_declarations = "in vec4 tintVS;\n";
  text.fragment = "gl_FragData[0] = tintVS;\n";
  return text;
}

}  // namespace

PointActor::PointActor(bool is_blended)
    : is_blended_(is_blended), shaded_(is_blended ? Pass::kBlended : Pass::kSolid, PointText()) {
  shaded_.SetCulling(false);
  actor()->SetVisibility(false);
  SetViewSize(1, 1);
}

void PointActor::SetViewSize(int width_px, int height_px) {
  constexpr float kClipExtent = 2;  // from -1 to 1
  const float per_pixel[2] = {kClipExtent / static_cast<float>(width_px),
                              kClipExtent / static_cast<float>(height_px)};
  shaded_.uniforms().SetUniform2f("clipPerPixel", per_pixel);
}

void PointActor::SetPoints(const std::vector<MarkerPoints>& all) {
  urdf::Mesh squares;
  names_.clear();
  for (const MarkerPoints& points : all) {
    if (points.is_blended != is_blended_) continue;
    const float unit = points.is_in_pixels ? kInPixels : kInMetres;
    const float right = 0.5f * points.size.x(), up = 0.5f * points.size.y();
    const auto part = static_cast<int>(names_.size());
    names_.push_back(points.name);
    for (std::size_t i = 0; i < points.positions.size(); ++i) {
      const std::size_t first = squares.positions.size();
      for (const auto& [x, y] : {std::pair(-right, -up), {right, -up}, {right, up}, {-right, up}}) {
        squares.AddVertex({x, y, unit}, points.positions[i]);
      }
      squares.Paint(first, points.colors[i], part);
      const auto corner = static_cast<std::uint32_t>(first);
      squares.AddTriangle(corner, corner + 1, corner + 2);
      squares.AddTriangle(corner, corner + 2, corner + 3);
    }
  }
  actor()->SetVisibility(!squares.triangles.empty());
  if (!squares.triangles.empty()) shaded_.SetMesh(squares);
}

}  // namespace kinescope::render
