#include "render/vtk/skin_shader.h"

#include <string>
#include <tuple>

#include "urdf/skin/load_regions.h"

namespace kinescope::render {
namespace {

// Soft light as from a clouded sky, less where limbs cover it, and a lamp over the viewer's left
// shoulder. It scales all channels equally, because hues carry meaning.
constexpr char kLitSkinFunction[] = R"(
float LightOnSkin(vec3 normal, vec2 sky) {
  float key = max(dot(normal, vec3(-0.439, 0.634, 0.637)) + 0.12, 0.0) / 1.12;
  float fill = max(dot(normal, vec3(0.816, 0.102, 0.569)) + 0.5, 0.0) / 1.5;
  float edge = 1.0 - max(normal.z, 0.0);
  float light = sky.y * (0.44 + 0.20 * sky.x + 0.16 * fill) + (0.35 + 0.65 * sky.y) * 0.50 * key;
  return light * (1.0 - 0.32 * edge * edge * edge);
}
)";

// Borders are signed distances: crisp at any zoom, and one pixel soft.
constexpr char kBordersFunction[] = R"(
vec3 Suit(vec4 borders) {
  vec4 inside = clamp(borders / (fwidth(borders) + 1e-6) + 0.5, 0.0, 1.0);
  vec3 color = mix(topColor, bandColor, inside.w);
  color = mix(color, trousersColor, inside.x);
  color = mix(color, shoesColor, inside.z);
  return mix(color, bareColor, inside.y);
}
)";

// Where no border is near, without what borders cost at each pixel.
constexpr char kSuitFunction[] = R"(
vec3 Suit(vec4 borders) {
  if (borders.y > 0.0) return bareColor;
  if (borders.z > 0.0) return shoesColor;
  if (borders.x > 0.0) return trousersColor;
  return borders.w > 0.0 ? bandColor : topColor;
}
)";

// A skin of the user's own has a colour at each vertex.
constexpr char kPaintFunction[] = "vec3 Suit(vec4 color) { return color.rgb; }\n";

constexpr char kSuitUniforms[] =
    "uniform vec3 topColor;\nuniform vec3 trousersColor;\nuniform vec3 shoesColor;\n"
    "uniform vec3 bareColor;\nuniform vec3 bandColor;\nuniform vec4 overrideColor;\n";

// A region is as large, and has the rim, that the sphere of its class has; hatched where the class
// is unknown. Returns its colour and its share of the pixel.
constexpr char kRegionFunction[] = R"(
vec4 Region(vec3 region) {
  int joint = int(region.y + 0.5);
  vec4 look = regionLook[joint];
  float rim = regionRim[joint];
  float soft = fwidth(region.x) + 1e-6;
  float share = look.a > 1.0 ? 0.0 : clamp((region.x - look.a) / soft + 0.5, 0.0, 1.0);
  float onRim = 1.0 - clamp((region.x - look.a - 0.14) / soft + 0.5, 0.0, 1.0);
  vec3 color = mix(look.rgb, rim > 0.0 ? vec3(0.15, 0.02, 0.02) : vec3(1.0), abs(rim) * onRim);
  float across = region.z / 0.014;
  float stripe = clamp((abs(fract(across) - 0.5) - 0.25) / (fwidth(across) + 1e-6) + 0.5, 0.0, 1.0);
  return vec4(color, share * (rim < 0.0 ? max(stripe, onRim) : 1.0));
}
)";

}  // namespace

bool SkinShading::operator<(const SkinShading& other) const {
  return std::tie(is_lit_at_vertices, has_loads, is_flat, is_suit, has_borders) <
         std::tie(other.is_lit_at_vertices, other.has_loads, other.is_flat, other.is_suit,
                  other.has_borders);
}

ShaderText SkinText(const SkinShading& shading) {
  constexpr char kSuit[] = "vec3 suit = mix(Suit(paint), overrideColor.rgb, overrideColor.a);\n";
  ShaderText text;
  text.vertex = R"(
  gl_Position = MCDCMatrix * vertexMC;
  normalVCVSOutput = normalMatrix * normalMC;
)";
  text.fragment_declarations = "uniform float opacityFactor;\n";
  const auto pass_on = [&](const std::string& type, const std::string& name) {
    text.vertex_declarations += "out " + type + " " + name + "VS;\n";
    text.vertex += name + "VS = " + name + ";\n";
    text.fragment_declarations += "in " + type + " " + name + "VS;\n";
    text.fragment += type + " " + name + " = " + name + "VS;\n";
  };
  if (shading.has_borders) {
    pass_on("vec4", "paint");
    text.fragment_declarations += kSuitUniforms;
    text.fragment_declarations += kBordersFunction;
    text.fragment += kSuit;
  } else {
    text.vertex_declarations += shading.is_suit ? kSuitFunction : kPaintFunction;
    text.vertex += kSuit;
    pass_on("vec3", "suit");
  }
  constexpr char kSky[] = "vec2 sky = vec2(0.5 + 0.5 * normalMC.z, openSky);\n";
  if (shading.is_flat) {
    text.fragment += "float light = 1.0;\n";
  } else if (shading.is_lit_at_vertices) {
    text.vertex_declarations += kLitSkinFunction;
    text.vertex += kSky;
    text.vertex += "float light = LightOnSkin(normalize(normalVCVSOutput), sky);\n";
    pass_on("float", "light");
  } else {
    text.vertex += kSky;
    pass_on("vec2", "sky");
    text.fragment_declarations += kLitSkinFunction;
    text.fragment += "float light = LightOnSkin(normalVCVSOutput, sky);\n";
  }
  text.fragment += "vec3 color = suit * light;\n";
  if (shading.has_loads) {
    const std::string count = "[" + std::to_string(skin::kRegions) + "];\n";
    pass_on("vec3", "region");
    text.fragment_declarations +=
        "uniform vec4 regionLook" + count + "uniform float regionRim" + count + kRegionFunction;
    // Between pure hue and full light, as on a sphere: a class reads the same on the dark side.
    text.fragment +=
        "vec4 load = Region(region);\n"
        "color = mix(color, load.rgb * mix(1.0, light, 0.75), load.a);\n";
  }
  text.fragment += "gl_FragData[0] = vec4(color, opacityFactor);\n";
  return text;
}

std::vector<VertexAttribute> SkinAttributes(const SkinShading& shading) {
  std::vector<VertexAttribute> attributes = {{"paint", 4}, {"openSky", 1}};
  if (shading.has_loads) attributes.push_back({"region", 3});
  return attributes;
}

}  // namespace kinescope::render
