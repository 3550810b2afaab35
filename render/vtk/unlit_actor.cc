#include "render/vtk/unlit_actor.h"

#include <vtkActor.h>

#include <cstdint>

namespace kinescope::render {
namespace {

ShaderText UnlitText(const std::string& place) {
  ShaderText text;
  text.vertex_declarations = "out vec4 tintVS;\n";
  text.vertex = place + R"(
  normalVCVSOutput = vec3(0.0, 0.0, 1.0);
  tintVS = tint;
)";
  text.fragment_declarations = "in vec4 tintVS;\n";
  text.fragment = "gl_FragData[0] = tintVS;\n";
  return text;
}

}  // namespace

UnlitActor::UnlitActor(bool is_blended, const std::string& place,
                       const std::vector<VertexAttribute>& attributes)
    : is_blended_(is_blended),
      shaded_(is_blended ? Pass::kBlended : Pass::kSolid, UnlitText(place), attributes) {
  shaded_.SetCulling(false);
  actor()->SetVisibility(false);
  SetViewSize(1, 1);
}

void UnlitActor::SetViewSize(int width_px, int height_px) {
  constexpr float kClipExtent = 2;  // from -1 to 1
  const float per_pixel[2] = {kClipExtent / static_cast<float>(width_px),
                              kClipExtent / static_cast<float>(height_px)};
  shaded_.uniforms().SetUniform2f("clipPerPixel", per_pixel);
}

void UnlitActor::Clear() {
  names_.clear();
  actor()->SetVisibility(false);
}

int UnlitActor::AddPart(const std::string& name) {
  names_.push_back(name);
  return static_cast<int>(names_.size()) - 1;
}

void UnlitActor::CloseSquare(urdf::Mesh& corners) {
  const auto first = static_cast<std::uint32_t>(corners.positions.size() - 4);
  corners.AddTriangle(first, first + 1, first + 2);
  corners.AddTriangle(first, first + 2, first + 3);
}

}  // namespace kinescope::render
