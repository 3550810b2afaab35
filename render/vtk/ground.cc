#include "render/vtk/ground.h"

#include <vtkActor.h>

#include <string>

namespace kinescope::render {
namespace {

std::string Constant(const char* name, const Rgb& color) {
  return std::string("const vec3 ") + name + " = vec3(" + std::to_string(color[0]) + ", " +
         std::to_string(color[1]) + ", " + std::to_string(color[2]) + ");\n";
}

constexpr double kFloorReach = 9;  // m; the floor has faded into the background there

// Lines are computed per pixel and averaged over it, so they neither flicker nor break up far away.
// It covers half the picture: every operation here counts, so the theme's colours are constants (as
// uniforms they cost a fifth of a picture whose camera moves).
ShaderText FloorText(Theme theme) {
  ShaderText text;
  text.vertex_declarations = "out vec2 floorVS;\n";
  text.vertex = R"(
  vec3 onFloor = vec3(vertexMC.xy + focus.xy, 0.0);
  gl_Position = MCDCMatrix * vec4(onFloor, 1.0);
  floorVS = onFloor.xy;
)";
  const ThemeColors& colors = ColorsOf(theme);
  text.fragment_declarations = Constant("plain", colors.floor) +
                               Constant("fineLine", colors.fine_line) +
                               Constant("line", colors.line) + R"(
in vec2 floorVS;
uniform vec3 focus;
uniform vec3 background;
// `cell`: pixels from one line to the next, in both directions; `width`: half a line's, in cells.
float Lines(vec2 at, vec2 cell, float width) {
  vec2 away = abs(fract(at - 0.5) - 0.5) * cell;
  vec2 drawn = max(width * cell, 1.0);
  vec2 lines = clamp(drawn - away + 0.5, 0.0, 1.0) * min(width * cell, 1.0);
  lines = mix(vec2(2.0 * width), lines, clamp(0.4 * cell - 0.8, 0.0, 1.0));
  return max(lines.x, lines.y);
}
)";
  text.fragment = R"(
  vec2 perMetre = 1.0 / fwidth(floorVS);
  vec2 away = (floorVS - focus.xy) * focus.z;
  float fade = max(1.0 - dot(away, away), 0.0);
  fade *= fade;
  float quarter = Lines(floorVS * 4.0, perMetre * 0.25, 0.012);
  float whole = Lines(floorVS, perMetre, 0.006);
  vec3 color = mix(plain, fineLine, 0.8 * quarter);
  color = mix(color, line, whole);
  gl_FragData[0] = vec4(mix(background, color, fade), 1.0);
)";
  return text;
}

}  // namespace

Ground::Ground()
    : light_(Pass::kBackdrop, FloorText(Theme::kLight)),
      dark_(Pass::kBackdrop, FloorText(Theme::kDark)) {
  urdf::Mesh disc;
  Eigen::Affine3d grow = Eigen::Affine3d::Identity();
  grow.scale(Eigen::Vector3d(kFloorReach, kFloorReach, 1));
  disc.Append(urdf::DiscMesh(24), grow);
  disc.Paint(0, Eigen::Vector4f::Ones(), 0);
  light_.SetMesh(disc);
  dark_.SetMesh(disc);
  SetLook(SceneLook());
  SetFocus(Eigen::Vector3d::Zero());
}

void Ground::SetLook(const SceneLook& look) {
  const Rgb& background = BackgroundOf(look);
  SetUniform("background", Eigen::Vector3d(background[0], background[1], background[2]));
  light_.actor()->SetVisibility(look.floor && look.theme == Theme::kLight);
  dark_.actor()->SetVisibility(look.floor && look.theme == Theme::kDark);
}

void Ground::SetFocus(const Eigen::Vector3d& focus) {
  // A disc with corners comes a little closer than its radius.
  SetUniform("focus", {focus.x(), focus.y(), 1 / (0.98 * kFloorReach)});
}

void Ground::SetUniform(const char* name, const Eigen::Vector3d& value) {
  const Eigen::Vector3f as_float = value.cast<float>();
  for (ShadedActor* floor : {&light_, &dark_}) {
    floor->uniforms().SetUniform3f(name, as_float.data());
  }
}

}  // namespace kinescope::render
