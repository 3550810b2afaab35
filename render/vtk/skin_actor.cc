#include "render/vtk/skin_actor.h"

#include <vtkActor.h>

#include <algorithm>

#include "core/palette.h"
#include "core/person_links.h"
#include "render/shape/coarser_mesh.h"
#include "render/vtk/float_array.h"
#include "urdf/skin/load_regions.h"

namespace kinescope::render {
namespace {

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
  suit_.clear();
  if (of.colors.empty()) {
    suit_ = skin::OutfitOf(of, build_);
    CopyInto(paint_, 4, suit_);
  } else {
    CopyInto(paint_, 4, ToFloats(of.colors));
  }
  paint_->SetName("paint");
  regions_->Initialize();
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
  const auto& [error_m, shading] = level;
  const std::vector<std::uint32_t> all = Indices(skin_->triangles());
  const std::vector<std::uint32_t> triangles =
      error_m > 0 ? CoarserTriangles(skin_->rest(), all, error_m) : all;
  auto shaded = std::make_unique<ShadedActor>(pass_, SkinText(shading), SkinAttributes(shading));
  std::vector<vtkFloatArray*> attributes = {paint_, open_sky_};
  if (shading.has_loads) {
    if (regions_->GetNumberOfTuples() == 0) FindRegions();
    attributes.push_back(regions_);
  }
  shaded->SetSurface(positions_, normals_, attributes, triangles);
  if (own_) shaded->SetCulling(!own_->is_two_sided);
  levels_[level] = std::move(shaded);
}

void SkinActor::FindRegions() {
  const skin::SkinTemplate& of = own_ ? *own_ : skin::BuiltInSkin();
  const std::vector<skin::LoadRegion> regions = skin::LoadRegionsOf(
      skin_->rest(), of.weights, skin_->triangles(), skin_->bind(), model_->human.skeleton.height);
  std::vector<Eigen::Vector3f> values;
  values.reserve(regions.size());
  for (std::size_t i = 0; i < regions.size(); ++i) {
    values.emplace_back(regions[i].inside, regions[i].joint,
                        skin_->rest()[i].dot(Eigen::Vector3f::Constant(0.577f)));
  }
  CopyInto(regions_, 3, values);
  regions_->SetName("region");
}

void SkinActor::ShowLoads(const std::vector<JointLoad>& loads, ShadedActor& shaded) {
  constexpr float kHidden = 2;
  constexpr int kCount = static_cast<int>(skin::kRegions);
  float looks[kCount][4] = {}, rims[kCount] = {};
  for (float(&look)[4] : looks) look[3] = kHidden;
  for (const JointLoad& load : loads) {
    const auto region = skin::RegionOf(load.joint);
    if (!region) continue;
    const Rgb color = ColorOf(load.load_class);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      looks[*region][channel] = static_cast<float>(color[channel]);
    }
    looks[*region][3] = static_cast<float>(1 - SizeOf(load.load_class));
    rims[*region] = static_cast<float>(RimOf(load.load_class));
  }
  shaded.uniforms().SetUniform4fv("regionLook", kCount, looks);
  shaded.uniforms().SetUniform1fv("regionRim", kCount, rims);
}

bool SkinActor::Update(const PersonState& person,
                       const std::shared_ptr<const skin::SkinTemplate>& own,
                       const Eigen::Vector4f& override_color, double opacity, double error_m,
                       const SkinShading& shading) {
  bool is_changed = false;
  const Level level(PermittedError({0.0003, 0.0006, 0.001, 0.002, 0.004, 0.006, 0.010}, error_m),
                    shading);
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
  ShadedActor& shaded = *levels_[level];
  for (const auto& [each, other] : levels_) {
    other->actor()->SetVisibility(is_visible_ && other.get() == &shaded);
  }
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
  if (shading.has_loads) ShowLoads(person.loads, shaded);
  return is_changed;
}

void SkinActor::AddLines(const Camera& camera, std::vector<SpaceLine>& lines) const {
  if (!is_visible_) return;
  const std::vector<std::uint32_t> triangles = Indices(skin_->triangles());
  std::vector<float> values(surface_.positions.size());
  const auto add = [&](LineKind kind) {
    for (SurfaceLine& line : ZeroLines(surface_.positions, triangles, values)) {
      lines.push_back({std::move(line), kind});
    }
  };
  const Eigen::Vector3f eye = camera.position.cast<float>();
  const Eigen::Vector3f back = (camera.position - camera.target).cast<float>();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Eigen::Vector3f to_eye =
        camera.is_orthographic() ? back : Eigen::Vector3f(eye - surface_.positions[i]);
    values[i] = surface_.normals[i].dot(to_eye);
  }
  add(LineKind::kOutline);
  if (suit_.empty()) return;
  for (float skin::Borders::*const border : {&skin::Borders::trousers, &skin::Borders::bare,
                                             &skin::Borders::shoes, &skin::Borders::bands}) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = suit_[i].*border;
    add(LineKind::kBorder);
  }
}

std::vector<vtkActor*> SkinActor::actors() {
  std::vector<vtkActor*> actors;
  for (const auto& [level, shaded] : levels_) actors.push_back(shaded->actor());
  return actors;
}

}  // namespace kinescope::render
