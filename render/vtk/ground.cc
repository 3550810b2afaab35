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
// and drawing the floor larger and averaging it gains nothing (59 to 62 dB against four times as
// large). It covers half the picture: every operation here counts, so only the nearest line is
// computed, once for both widths, and the theme's colours are constants (as uniforms they cost a
// fifth of a picture whose camera moves).
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
)";
  text.fragment = R"(
  vec2 at = floorVS * 4.0;
  vec2 line0 = floor(at + 0.5);
  vec2 dx = dFdx(floorVS), dy = dFdy(floorVS);
  vec2 cell = 0.25 * inversesqrt(dx * dx + dy * dy);
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
  return text;
}

}  // namespace

Ground::Floor::Floor(Theme theme_of)
    : theme(theme_of), actor(Pass::kBackdrop, FloorText(theme_of)) {}

std::array<vtkActor*, 2> Ground::actors() {
  return {floors_[0].actor.actor(), floors_[1].actor.actor()};
}

Ground::Ground() : floors_{Floor(Theme::kLight), Floor(Theme::kDark)} {
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
    floor.actor.actor()->SetVisibility(look.floor && floor.theme == look.theme);
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
