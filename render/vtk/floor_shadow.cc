#include "render/vtk/floor_shadow.h"

#include <vtkActor.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "render/vtk/float_array.h"

namespace kinescope::render {
namespace {

constexpr int kSide = 30;              // points
constexpr float kMargin = 0.45f;       // m, around the limbs
constexpr float kAboveFloor = 0.002f;  // m
constexpr float kDarkest = 0.8f, kUnseen = 0.01f;

constexpr std::size_t PointAt(int row, int column) {
  return static_cast<std::size_t>(row) * kSide + static_cast<std::size_t>(column);
}

ShaderText ShadowText() {
  ShaderText text;
  text.vertex_declarations = "out float shadeVS;\n";
  text.vertex =
      "  gl_Position = MCDCMatrix * vertexMC;\n"
      "  normalVCVSOutput = vec3(0.0, 0.0, 1.0);\n"
      "  shadeVS = shade;\n";
  text.fragment_declarations = "in float shadeVS;\nuniform vec3 shadowColor;\n";
  text.fragment = "gl_FragData[0] = vec4(shadowColor, shadeVS);\n";
  return text;
}

}  // namespace

FloorShadow::FloorShadow()
    : shaded_(Pass::kBlended, ShadowText(), {{"shade", 1}}),
      points_(static_cast<std::size_t>(kSide) * kSide, Eigen::Vector3f::Zero()) {
  const std::vector<float> none(points_.size(), 0);
  CopyInto(positions_, 3, points_);
  CopyInto(shade_, 1, none);
  shade_->SetName("shade");
  const std::vector<Eigen::Vector3f> up(points_.size(), Eigen::Vector3f::UnitZ());
  shaded_.SetSurface(positions_, ToFloatArray("Normals", 3, up), {shade_}, {});
}

void FloorShadow::Cast(const skin::Capsules& limbs, const Rgb& color) {
  Eigen::Vector2f lowest = limbs.front().start.head<2>(), highest = lowest;
  for (const skin::Capsule& limb : limbs) {
    for (const Eigen::Vector3f& end : {limb.start, limb.end}) {
      lowest = lowest.cwiseMin(end.head<2>());
      highest = highest.cwiseMax(end.head<2>());
    }
  }
  // No larger than the shadow: pixels cost more than points.
  const Eigen::Vector2f first = lowest.array() - kMargin;
  const Eigen::Vector2f step = ((highest - lowest).array() + 2 * kMargin) / (kSide - 1);
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      points_[PointAt(row, column)] = {first.x() + static_cast<float>(column) * step.x(),
                                       first.y() + static_cast<float>(row) * step.y(), kAboveFloor};
    }
  }
  skin::SetOpenSky(points_, limbs, open_);
  // As if light came from the cloudy part of the sky only: it makes the shadow three times as deep.
  // It ends before the grid does.
  const auto fade = [](int i) {
    const float inside = static_cast<float>(std::min(i, kSide - 1 - i)) / (0.25f * kSide);
    return std::min(1.0f, inside);
  };
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      float& open = open_[PointAt(row, column)];
      const float left = fade(row) * fade(column);
      open = std::max(0.0f, kDarkest * (1 - open * open * open) * left * left - kUnseen);
    }
  }
  // Pixels of no shadow cost as much as others.
  shown_.clear();
  for (int row = 0; row + 1 < kSide; ++row) {
    for (int column = 0; column + 1 < kSide; ++column) {
      const std::size_t a = PointAt(row, column), b = a + 1, c = a + kSide + 1, d = a + kSide;
      if (open_[a] + open_[b] + open_[c] + open_[d] == 0) continue;
      for (const std::size_t corner : {a, b, c, a, c, d}) {
        shown_.push_back(static_cast<std::uint32_t>(corner));
      }
    }
  }
  shaded_.SetTriangles(shown_);
  CopyInto(positions_, 3, points_);
  CopyInto(shade_, 1, open_);
  shaded_.SetColor("shadowColor", color);
}

void FloorShadow::AddTo(PictureRegion& region) const {
  if (shaded_.is_visible()) region.AddTriangles(points_, shown_);
}

}  // namespace kinescope::render
