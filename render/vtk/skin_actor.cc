#include "render/vtk/skin_actor.h"

#include <vtkActor.h>

#include "core/palette.h"
#include "core/skin_inputs.h"
#include "render/shape/coarser_mesh.h"
#include "render/shape/coarser_skin.h"
#include "urdf/skin/load_regions.h"
#include "urdf/skin/outfit.h"

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

void ShowLoads(const std::vector<JointLoad>& loads, ShadedActor& shaded) {
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

}  // namespace

std::unique_ptr<SkinSurface> SkinActor::SurfaceWithin(double error_m) const {
  std::shared_ptr<const skin::SkinTemplate> of = own_;
  if (of == nullptr) of = {std::shared_ptr<void>(), &skin::BuiltInSkin()};
  FineNormals normals;
  if (error_m > 0) {
    CoarserSkin coarser = MakeCoarserSkin(*of, build_, model_->human.skeleton, error_m);
    of = std::make_shared<skin::SkinTemplate>(std::move(coarser.skin));
    normals = std::move(coarser.normals);
  }
  return std::make_unique<SkinSurface>(std::move(of), std::move(normals), build_, *model_);
}

void SkinActor::AddActors(const SkinShading& shading, Level& level) const {
  SkinSurface& surface = *level.surface;
  Actors& actors = level.actors[shading];
  const auto add = [&](const SkinShading& shading_of,
                       const std::vector<skin::Triangle>& triangles) {
    if (triangles.empty()) return;
    auto shaded =
        std::make_unique<ShadedActor>(pass_, SkinText(shading_of), SkinAttributes(shading_of));
    shaded->SetSurface(surface.positions(), surface.normals(),
                       surface.attributes(shading_of.has_loads), Indices(triangles));
    if (own_) shaded->SetCulling(!own_->is_two_sided);
    actors.push_back(std::move(shaded));
  };
  // One that shines through is drawn at once: its nearest layer is known only when all of it is.
  const bool is_whole = pass_ == Pass::kVeil && !surface.suit().empty();
  std::vector<skin::Triangle> plain, bordered;
  for (const skin::Triangle& triangle : surface.triangles()) {
    (is_whole || skin::HasBorder(surface.suit(), triangle) ? bordered : plain).push_back(triangle);
  }
  add(shading, plain);
  SkinShading with_borders = shading;
  with_borders.has_borders = true;
  add(with_borders, bordered);
}

void SkinActor::Show(const PersonState& person, const Eigen::Vector4f& override_color,
                     double opacity, const SkinShading& shading, ShadedActor& shaded) const {
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
}

bool SkinActor::Update(const PersonState& person,
                       const std::shared_ptr<const skin::SkinTemplate>& own,
                       const Eigen::Vector4f& override_color, double opacity, double error_m,
                       const SkinShading& shading) {
  bool is_changed = false;
  if (model_ != person.model || revision_ != person.model->revision || own_ != own) {
    own_ = own;
    model_ = person.model;
    revision_ = person.model->revision;
    build_ = BuildOf(*model_);
    levels_.clear();
    is_changed = true;
  }
  // Borders of load classes may be anywhere, and would be ragged on large triangles.
  if (shading.has_loads) error_m = 0;
  const double error = PermittedError(
      {0.0003, 0.0006, 0.0008, 0.001, 0.0014, 0.002, 0.003, 0.004, 0.006, 0.010}, error_m);
  Level& level = levels_[error];
  if (!level.surface) level.surface = SurfaceWithin(error);
  capsules_ = skin::CapsulesOf(model_->human.skeleton, build_, person.links);
  level.surface->Move(person, capsules_);
  if (level.actors.count(shading) == 0) {
    AddActors(shading, level);
    is_changed = true;
  }
  for (const auto& [each, of_level] : levels_) {
    for (const auto& [of_shading, actors] : of_level.actors) {
      const bool is_shown = is_visible_ && &of_level == &level && &actors == &level.actors[shading];
      for (const auto& shaded : actors) shaded->actor()->SetVisibility(is_shown);
    }
  }
  for (const auto& shaded : level.actors[shading]) {
    Show(person, override_color, opacity, shading, *shaded);
  }
  shown_ = &level;
  return is_changed;
}

void SkinActor::AddTo(PictureRegion& region) const {
  if (!is_visible_ || shown_ == nullptr) return;
  const std::vector<skin::Triangle>& triangles = shown_->surface->triangles();
  region.AddTriangles(shown_->surface->surface().positions, triangles);
}

void SkinActor::AddLines(const Camera& camera, std::vector<SpaceLine>& lines) const {
  if (is_visible_) shown_->surface->AddLines(camera, lines);
}

std::vector<vtkActor*> SkinActor::actors() {
  std::vector<vtkActor*> actors;
  for (const auto& [error, level] : levels_) {
    for (const auto& [shading, of_shading] : level.actors) {
      for (const auto& shaded : of_shading) actors.push_back(shaded->actor());
    }
  }
  return actors;
}

}  // namespace kinescope::render
