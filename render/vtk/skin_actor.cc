#include "render/vtk/skin_actor.h"

#include <vtkActor.h>

#include "core/palette.h"
#include "core/person_links.h"
#include "render/shape/coarser_mesh.h"
#include "render/vtk/float_array.h"
#include "urdf/skin/outfit.h"

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
constexpr char kSuitFunction[] = R"(
vec3 Suit(vec4 borders) {
  vec4 inside = clamp(borders / (fwidth(borders) + 1e-6) + 0.5, 0.0, 1.0);
  vec3 color = mix(topColor, bandColor, inside.w);
  color = mix(color, trousersColor, inside.x);
  color = mix(color, shoesColor, inside.z);
  return mix(color, bareColor, inside.y);
}
)";

// A skin of the user's own has a colour at each vertex.
constexpr char kPaintFunction[] = "vec3 Suit(vec4 color) { return color.rgb; }\n";

ShaderText SkinText(bool is_suit, bool is_lit_at_vertices) {
  ShaderText text;
  text.vertex_declarations = "out vec4 paintVS;\nout vec2 skyVS;\n";
  text.vertex = R"(
  gl_Position = MCDCMatrix * vertexMC;
  normalVCVSOutput = normalMatrix * normalMC;
  skyVS = vec2(0.5 + 0.5 * normalMC.z, openSky);
  paintVS = paint;
)";
  text.fragment_declarations =
      "in vec4 paintVS;\nin vec2 skyVS;\n"
      "uniform vec3 topColor;\nuniform vec3 trousersColor;\nuniform vec3 shoesColor;\n"
      "uniform vec3 bareColor;\nuniform vec3 bandColor;\nuniform vec4 overrideColor;\n"
      "uniform float opacityFactor;\n";
  text.fragment_declarations += is_suit ? kSuitFunction : kPaintFunction;
  if (is_lit_at_vertices) {
    text.vertex_declarations += "out float lightVS;\n";
    text.vertex_declarations += kLitSkinFunction;
    text.vertex += "  lightVS = LightOnSkin(normalize(normalVCVSOutput), skyVS);\n";
    text.fragment_declarations += "in float lightVS;\n";
    text.fragment =
        "vec3 suit = mix(Suit(paintVS), overrideColor.rgb, overrideColor.a);\n"
        "gl_FragData[0] = vec4(suit * lightVS, opacityFactor);\n";
    return text;
  }
  text.fragment_declarations += kLitSkinFunction;
  text.fragment =
      "vec3 suit = mix(Suit(paintVS), overrideColor.rgb, overrideColor.a);\n"
      "float light = LightOnSkin(normalVCVSOutput, skyVS);\n"
      "gl_FragData[0] = vec4(suit * light, opacityFactor);\n";
  return text;
}

std::vector<std::uint32_t> Indices(const std::vector<skin::Triangle>& triangles) {
  std::vector<std::uint32_t> indices;
  indices.reserve(3 * triangles.size());
  for (const skin::Triangle& triangle : triangles) {
    indices.insert(indices.end(), triangle.begin(), triangle.end());
  }
  return indices;
}

std::vector<Eigen::Vector4f> ToFloats(const std::vector<skin::SkinTemplate::Color>& colors) {
  std::vector<Eigen::Vector4f> floats;
  floats.reserve(colors.size());
  for (const auto& color : colors) {
    floats.push_back(Eigen::Vector4f(color[0], color[1], color[2], color[3]) / 255);
  }
  return floats;
}

bool AreEqual(const std::vector<urdf::Pose>& a, const std::vector<urdf::Pose>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.position == y.position && x.orientation.coeffs() == y.orientation.coeffs();
  });
}

}  // namespace

void SkinActor::Load(const PersonModel& model) {
  const urdf::HumanModel& human = model.human;
  build_ = skin::BuildOf(model.description.sex == urdf::Sex::kFemale, human.skeleton.height,
                         model.description.mass_kg);
  std::array<const urdf::HandSkeleton*, 2> gloves{};
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    if (human.gloves[side]) gloves[side] = &*human.gloves[side];
  }
  const skin::SkinTemplate& of = own_ ? *own_ : skin::BuiltInSkin();
  skin_ = std::make_unique<skin::PersonSkin>(of, build_, human.skeleton, gloves);
  if (of.colors.empty()) {
    CopyInto(paint_, 4, skin::OutfitOf(of, build_));
  } else {
    CopyInto(paint_, 4, ToFloats(of.colors));
  }
  paint_->SetName("paint");
  limbs_ = skin::LimbRunsOf(of.weights);
  shown_.clear();
}

void SkinActor::Move(const PersonState& person) {
  std::vector<urdf::Pose> poses = VisibleLinkPoses(person);
  if (AreEqual(poses, shown_)) return;
  std::array<const urdf::FingerPoses*, 2> fingers{};
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    if (person.gloves[side]) fingers[side] = &person.gloves[side]->links;
  }
  skin_->Pose(person.links, fingers, surface_);
  capsules_ = skin::CapsulesOf(model_->human.skeleton, build_, person.links);
  skin::SetOpenSky(surface_.positions, surface_.normals, limbs_, capsules_, open_);
  CopyInto(open_sky_, 1, open_);
  open_sky_->SetName("openSky");
  CopyInto(positions_, 3, surface_.positions);
  CopyInto(normals_, 3, surface_.normals);
  shown_ = std::move(poses);
}

void SkinActor::AddLevel(const Level& level) {
  const auto& [error_m, is_lit_at_vertices] = level;
  const std::vector<std::uint32_t> all = Indices(skin_->triangles());
  const std::vector<std::uint32_t> triangles =
      error_m > 0 ? CoarserTriangles(skin_->rest(), all, error_m) : all;
  auto shaded =
      std::make_unique<ShadedActor>(pass_, SkinText(!own_, is_lit_at_vertices),
                                    std::vector<VertexAttribute>{{"paint", 4}, {"openSky", 1}});
  shaded->SetSurface(positions_, normals_, {paint_, open_sky_}, triangles);
  if (own_) shaded->SetCulling(!own_->is_two_sided);
  levels_[level] = std::move(shaded);
}

bool SkinActor::Update(const PersonState& person,
                       const std::shared_ptr<const skin::SkinTemplate>& own,
                       const Eigen::Vector4f& override_color, double opacity, double error_m,
                       bool is_lit_at_vertices) {
  bool is_changed = false;
  const Level level(PermittedError({0.0003, 0.0006, 0.001, 0.002, 0.004, 0.006, 0.010}, error_m),
                    is_lit_at_vertices);
  if (model_ != person.model || revision_ != person.model->revision || own_ != own) {
    own_ = own;
    model_ = person.model;
    revision_ = person.model->revision;
    levels_.clear();
    Load(*model_);
    is_changed = true;
  }
  Move(person);
  if (levels_.count(level) == 0) {
    AddLevel(level);
    is_changed = true;
  }
  for (const auto& [each, other] : levels_) {
    other->actor()->SetVisibility(is_visible_ && each == level);
  }
  ShadedActor& shaded = *levels_[level];
  if (!own_) {
    const SuitColors& colors = model_->suit;
    shaded.SetColor("topColor", colors.top);
    shaded.SetColor("trousersColor", colors.trousers);
    shaded.SetColor("shoesColor", colors.shoes);
    shaded.SetColor("bareColor", colors.bare);
    shaded.SetColor("bandColor", colors.band);
  }
  shaded.uniforms().SetUniform4f("overrideColor", override_color.data());
  shaded.uniforms().SetUniformf("opacityFactor", static_cast<float>(opacity));
  return is_changed;
}

std::vector<vtkActor*> SkinActor::actors() {
  std::vector<vtkActor*> actors;
  for (const auto& [level, shaded] : levels_) actors.push_back(shaded->actor());
  return actors;
}

}  // namespace kinescope::render
