#include "render/vtk/ground.h"

namespace kinescope::render {
namespace {

constexpr double kReach = 9;  // m; the floor has faded into the background there

// Lines are computed per pixel and averaged over it, so they neither flicker nor break up far away.
// It covers half the picture: every operation here counts.
ShaderText MakeText() {
  ShaderText text;
  text.vertex_declarations = "out vec2 floorVS;\n";
  text.vertex = R"(
  vec3 onFloor = vec3(vertexMC.xy + focus.xy, 0.0);
  gl_Position = MCDCMatrix * vec4(onFloor, 1.0);
  floorVS = onFloor.xy;
)";
  text.fragment_declarations = R"(
in vec2 floorVS;
uniform vec3 focus;
uniform vec3 background;
uniform vec3 plain;
uniform vec3 fineLine;
uniform vec3 line;
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

Ground::Ground() : shaded_(Pass::kBackdrop, MakeText()) {
  Mesh disc;
  Eigen::Affine3d grow = Eigen::Affine3d::Identity();
  grow.scale(Eigen::Vector3d(kReach, kReach, 1));
  disc.Append(DiscMesh(24), grow);
  disc.Paint(0, Eigen::Vector4f::Ones(), 0);
  shaded_.SetMesh(disc);
  SetLook(SceneLook());
  SetFocus(Eigen::Vector3d::Zero());
}

void Ground::SetLook(const SceneLook& look) {
  const auto set = [&](const char* name, const Rgb& color) {
    const float value[] = {static_cast<float>(color[0]), static_cast<float>(color[1]),
                           static_cast<float>(color[2])};
    shaded_.uniforms().SetUniform3f(name, value);
  };
  const ThemeColors& colors = ColorsOf(look.theme);
  set("background", BackgroundOf(look));
  set("plain", colors.floor);
  set("fineLine", colors.fine_line);
  set("line", colors.line);
}

void Ground::SetFocus(const Eigen::Vector3d& focus) {
  // A disc with corners comes a little closer than its radius.
  const float value[] = {static_cast<float>(focus.x()), static_cast<float>(focus.y()),
                         static_cast<float>(1 / (0.98 * kReach))};
  shaded_.uniforms().SetUniform3f("focus", value);
}

}  // namespace kinescope::render
