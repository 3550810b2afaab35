#include "render/vtk/line_actor.h"

#include <vtkActor.h>

#include <cstdint>

#include "render/vtk/float_array.h"

namespace kinescope::render {
namespace {

// The place of a corner says where it is: at the begin (0) or the end (1), on the one side (-1) or
// the other (1). Its normal is the place of its end of the line: VTK leaves out triangles with two
// corners at one place. What is behind the camera is cut off here, because the width of a line is
// across its direction on the screen.
constexpr float kCorners[4][2] = {{0, -1}, {0, 1}, {1, 1}, {1, -1}};

ShaderText LineText() {
  ShaderText text;
  text.vertex_declarations = "out vec4 tintVS;\n";
  text.vertex = R"(
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
  normalVCVSOutput = vec3(0.0, 0.0, 1.0);
  tintVS = tint;
)";
  text.fragment_declarations = "in vec4 tintVS;\n";
  text.fragment = "gl_FragData[0] = tintVS;\n";
  return text;
}

}  // namespace

LineActor::LineActor(bool is_blended)
    : is_blended_(is_blended),
      shaded_(is_blended ? Pass::kBlended : Pass::kSolid, LineText(),
              {{"part", 1}, {"tint", 4}, {"otherEnd", 3}}) {
  shaded_.SetCulling(false);
  actor()->SetVisibility(false);
  SetViewSize(1, 1);
}

void LineActor::SetViewSize(int width_px, int height_px) {
  constexpr float kClipExtent = 2;  // from -1 to 1
  const float per_pixel[2] = {kClipExtent / static_cast<float>(width_px),
                              kClipExtent / static_cast<float>(height_px)};
  shaded_.uniforms().SetUniform2f("clipPerPixel", per_pixel);
}

void LineActor::SetLines(const std::vector<MarkerLines>& all) {
  urdf::Mesh corners;
  std::vector<Eigen::Vector3f> others;
  names_.clear();
  for (const MarkerLines& lines : all) {
    if (lines.is_blended != is_blended_) continue;
    const auto part = static_cast<int>(names_.size());
    names_.push_back(lines.name);
    for (std::size_t i = 0; i + 1 < lines.positions.size(); i += 2) {
      const auto first = static_cast<std::uint32_t>(corners.positions.size());
      for (const auto& [end, side] : kCorners) {
        const std::size_t own = end < 1 ? i : i + 1, other = end < 1 ? i + 1 : i;
        corners.AddVertex({end, side, 0}, lines.positions[own]);
        corners.Paint(corners.positions.size() - 1, lines.colors[own], part);
        others.push_back(lines.positions[other]);
      }
      corners.AddTriangle(first, first + 1, first + 2);
      corners.AddTriangle(first, first + 2, first + 3);
    }
  }
  actor()->SetVisibility(!corners.triangles.empty());
  if (corners.triangles.empty()) return;
  const auto positions = ToFloatArray("position", 3, corners.positions);
  const auto normals = ToFloatArray("Normals", 3, corners.normals);
  const auto parts = ToFloatArray("part", 1, corners.parts);
  const auto tints = ToFloatArray("tint", 4, corners.colors);
  const auto ends = ToFloatArray("otherEnd", 3, others);
  shaded_.SetSurface(positions, normals, {parts, tints, ends}, corners.triangles);
}

}  // namespace kinescope::render
