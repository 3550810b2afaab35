#include "render/shape/skin_lines.h"

#include <cmath>
#include <utility>

#include "render/shape/contact_lines.h"
#include "render/shape/smooth_line.h"
#include "render/shape/surface_lines.h"

namespace kinescope::render {
namespace {

using Eigen::Vector3f;

constexpr double kOutlineWave = 0.020, kBorderWave = 0.03;  // m: waves that come from triangles
constexpr double kLeastLid = 0.008;                         // of the picture's height
constexpr double kLidWidth = 0.025;                         // m

// Triangles in which `values` are continuous: elsewhere, parts with borders of their own meet.
std::vector<std::uint32_t> Continuous(const std::vector<std::uint32_t>& triangles,
                                      const std::vector<Vector3f>& rest,
                                      const std::vector<float>& values) {
  constexpr float kSteepest = 2.5f;  // of a distance, with the fit to a person
  std::vector<std::uint32_t> continuous;
  const auto jumps = [&](std::uint32_t a, std::uint32_t b) {
    return std::abs(values[a] - values[b]) > kSteepest * (rest[a] - rest[b]).norm();
  };
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const std::uint32_t a = triangles[i], b = triangles[i + 1], c = triangles[i + 2];
    if ((values[a] < 0) == (values[b] < 0) && (values[b] < 0) == (values[c] < 0)) continue;
    if (!jumps(a, b) && !jumps(b, c) && !jumps(c, a))
      continuous.insert(continuous.end(), {a, b, c});
  }
  return continuous;
}

}  // namespace

SkinLines::SkinLines(const skin::SkinTemplate& skin, const skin::Build& build,
                     std::vector<Vector3f> rest, std::vector<skin::Borders> suit)
    : rest_(std::move(rest)), suit_(std::move(suit)) {
  for (const skin::Triangle& triangle : skin.triangles) {
    triangles_.insert(triangles_.end(), triangle.begin(), triangle.end());
  }
  if (!suit_.empty()) face_.emplace(skin, build);
}

void SkinLines::AddTo(std::vector<SpaceLine>& lines, const skin::PersonSkin::Surface& surface,
                      const Camera& camera) const {
  std::vector<float> values(surface.positions.size());
  const Vector3f eye = camera.position.cast<float>();
  const Vector3f back = (camera.position - camera.target).cast<float>();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Vector3f to_eye = camera.is_orthographic() ? back : Vector3f(eye - surface.positions[i]);
    values[i] = surface.normals[i].dot(to_eye);
  }
  for (const SurfaceLine& line : ZeroLines(surface.positions, triangles_, values)) {
    lines.push_back({Smoothed(line, kOutlineWave), LineKind::kOutline});
  }
  for (SurfaceLine& line : ContactLines(surface.positions, rest_, triangles_)) {
    lines.push_back({std::move(line), LineKind::kCrease});
  }
  if (suit_.empty()) return;
  for (float skin::Borders::*const border : {&skin::Borders::trousers, &skin::Borders::bare,
                                             &skin::Borders::shoes, &skin::Borders::bands}) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = suit_[i].*border;
    for (const SurfaceLine& line :
         ZeroLines(surface.positions, Continuous(triangles_, rest_, values), values)) {
      lines.push_back({Smoothed(line, kBorderWave), LineKind::kBorder});
    }
  }
  std::vector<SurfaceLine> face = face_->On(surface.positions);
  if (face.empty()) return;
  constexpr int kSide = 1000;  // px
  const Projected at = Project(face.front().points.front().cast<double>(), camera, kSide, kSide);
  if (!(at.depth_m > 0) || kLidWidth * at.px_per_m < kLeastLid * kSide) return;
  for (SurfaceLine& line : face) lines.push_back({std::move(line), LineKind::kFace});
}

}  // namespace kinescope::render
