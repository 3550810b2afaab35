#include "render/vtk/ground.h"

#include <vtkActor.h>

#include <string>

namespace kinescope::render {
namespace {

std::string Constant(const char* name, const Rgb& color) {
  return std::string("const vec3 ") + name + " = vec3(" + std::to_string(color[0]) + ", " +
         std::to_string(color[1]) + ", " + std::to_string(color[2]) + ");\n";
}

// Each pixel has the share of it that lines cover, so they neither flicker nor break up far away,
// and drawing it larger and averaging gains nothing (58 to 61 dB against four times as large). It
// covers half the picture: every operation here counts, so the theme's colours are constants (as
// uniforms they cost a fifth of a picture whose camera moves).
ShaderText FloorText(Theme theme, Detail detail) {
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
  vec2 reach = width * cell;
  vec2 lines = clamp(reach + 0.5 - away, vec2(0.0), min(2.0 * reach, 1.0));
  lines = mix(vec2(2.0 * width), lines, clamp(0.4 * cell - 0.8, 0.0, 1.0));
  return max(lines.x, lines.y);
}
)";
  // The nearest line alone, once for both widths: three fifths of the time, and nearly the picture
  // of the other.
  const char* const quick = R"(
  vec2 at = floorVS * 4.0;
  vec2 line0 = floor(at + 0.5);
  vec2 cell = 0.25 / fwidth(floorVS);
  vec2 metres = line0 * 0.25;
  vec2 isWhole = vec2(equal(metres, floor(metres)));
  vec2 width = cell * (0.012 + 0.012 * isWhole);
  vec2 lines = clamp(width + 0.5 - abs(at - line0) * cell, vec2(0.0), min(2.0 * width, 1.0));
  vec2 whole = lines * isWhole;
  vec2 others = lines - whole;
  float sharp = clamp(0.4 * min(cell.x, cell.y) - 0.8, 0.0, 1.0);
  float fine = mix(0.024, max(others.x, others.y), sharp);
  vec3 color = plain + (0.8 * fine) * (fineLine - plain);
  color += max(whole.x, whole.y) * (line - color);
  vec2 away = (floorVS - focus.xy) * focus.z;
  float fade = max(1.0 - dot(away, away), 0.0);
  gl_FragData[0] = vec4(background + (fade * fade) * (color - background), 1.0);
)";
  text.fragment = R"(
  vec2 dx = dFdx(floorVS), dy = dFdy(floorVS);
  vec2 perMetre = inversesqrt(dx * dx + dy * dy);
  vec2 away = (floorVS - focus.xy) * focus.z;
  float fade = max(1.0 - dot(away, away), 0.0);
  fade *= fade;
  float quarter = Lines(floorVS * 4.0, perMetre * 0.25, 0.012);
  float whole = Lines(floorVS, perMetre, 0.006);
  vec3 color = mix(plain, fineLine, 0.8 * quarter);
  color = mix(color, line, whole);
  gl_FragData[0] = vec4(mix(background, color, fade), 1.0);
)";
  if (detail == Detail::kBySize) text.fragment = quick;
  return text;
}

}  // namespace

Ground::Floor::Floor(Theme theme_of, Detail detail_of)
    : theme(theme_of), detail(detail_of), actor(Pass::kBackdrop, FloorText(theme_of, detail_of)) {}

std::array<vtkActor*, 4> Ground::actors() {
  std::array<vtkActor*, 4> actors{};
  for (std::size_t i = 0; i < actors.size(); ++i) actors[i] = floors_[i].actor.actor();
  return actors;
}

Ground::Ground()
    : floors_{{{Theme::kLight, Detail::kFull},
               {Theme::kDark, Detail::kFull},
               {Theme::kLight, Detail::kBySize},
               {Theme::kDark, Detail::kBySize}}} {
  urdf::Mesh disc;
  Eigen::Affine3d grow = Eigen::Affine3d::Identity();
  grow.scale(Eigen::Vector3d(kFloorReach, kFloorReach, 1));
  disc.Append(urdf::DiscMesh(24), grow);
  disc.Paint(0, Eigen::Vector4f::Ones(), 0);
  for (Floor& floor : floors_) floor.actor.SetMesh(disc);
  SetLook(SceneLook());
  SetFocus(Eigen::Vector3d::Zero());
}

void Ground::SetLook(const SceneLook& look) {
  const Rgb& background = BackgroundOf(look);
  SetUniform("background", Eigen::Vector3d(background[0], background[1], background[2]));
  for (Floor& floor : floors_) {
    const bool is_asked_for = floor.theme == look.theme && floor.detail == look.detail;
    floor.actor.actor()->SetVisibility(look.floor && is_asked_for);
  }
}

void Ground::SetFocus(const Eigen::Vector3d& focus) {
  SetUniform("focus", {focus.x(), focus.y(), 1 / kFloorEnd});
}

void Ground::SetUniform(const char* name, const Eigen::Vector3d& value) {
  const Eigen::Vector3f as_float = value.cast<float>();
  for (Floor& floor : floors_) floor.actor.uniforms().SetUniform3f(name, as_float.data());
}

}  // namespace kinescope::render
