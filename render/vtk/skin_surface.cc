#include "render/vtk/skin_surface.h"

#include <algorithm>
#include <utility>

#include "core/person_links.h"
#include "core/skin_inputs.h"
#include "render/vtk/float_array.h"
#include "urdf/skin/load_regions.h"

namespace kinescope::render {
namespace {

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

SkinSurface::SkinSurface(std::shared_ptr<const skin::SkinTemplate> skin, FineNormals fine_normals,
                         const skin::Build& build, const PersonModel& model)
    : skin_(std::move(skin)),
      fine_normals_(std::move(fine_normals)),
      build_(build),
      person_(*skin_, build, model.human.skeleton, GlovesOf(model.human)),
      stature_(model.human.skeleton.height),
      limbs_(skin::LimbRunsOf(skin_->weights)) {
  if (skin_->colors.empty()) {
    suit_ = skin::OutfitOf(*skin_, build);
    CopyInto(paint_, 4, suit_);
  } else {
    CopyInto(paint_, 4, ToFloats(skin_->colors));
  }
  paint_->SetName("paint");
  open_sky_->SetName("openSky");
  regions_->SetName("region");
}

void SkinSurface::Move(const PersonState& person, const skin::Capsules& capsules) {
  std::vector<urdf::Pose> poses = VisibleLinkPoses(person);
  if (AreEqual(poses, shown_)) return;
  person_.Pose(person.links, FingersOf(person), surface_);
  fine_normals_.Apply(surface_);
  skin::SetOpenSky(surface_.positions, surface_.normals, limbs_, capsules, open_);
  CopyInto(open_sky_, 1, open_);
  CopyInto(positions_, 3, surface_.positions);
  CopyInto(normals_, 3, surface_.normals);
  shown_ = std::move(poses);
}

std::vector<vtkFloatArray*> SkinSurface::attributes(bool has_loads) {
  if (!has_loads) return {paint_, open_sky_};
  if (regions_->GetNumberOfTuples() == 0) FindRegions();
  return {paint_, open_sky_, regions_};
}

void SkinSurface::AddLines(const Camera& camera, std::vector<SpaceLine>& lines) {
  if (!lines_) lines_ = std::make_unique<SkinLines>(*skin_, build_, person_.rest(), suit_);
  lines_->AddTo(lines, surface_, camera);
}

void SkinSurface::FindRegions() {
  const std::vector<skin::LoadRegion> regions = skin::LoadRegionsOf(
      person_.rest(), skin_->weights, skin_->triangles, person_.bind(), stature_);
  std::vector<Eigen::Vector3f> values;
  values.reserve(regions.size());
  for (std::size_t i = 0; i < regions.size(); ++i) {
    values.emplace_back(regions[i].inside, regions[i].joint,
                        person_.rest()[i].dot(Eigen::Vector3f::Constant(0.577f)));
  }
  CopyInto(regions_, 3, values);
}

}  // namespace kinescope::render
