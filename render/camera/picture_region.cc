#include "render/camera/picture_region.h"

#include <algorithm>
#include <cmath>

#include "render/camera/camera_matrices.h"

namespace kinescope::render {
namespace {

Eigen::Matrix4f ClipFromWorld(const Camera& camera, int width, int height) {
  const double aspect = static_cast<double>(width) / height;
  const glm::dmat4 matrix = ClipFromView(camera, aspect) * ViewFromWorld(camera);
  Eigen::Matrix4f result;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      result(row, column) = static_cast<float>(matrix[column][row]);
    }
  }
  return result;
}

}  // namespace

PictureRegion::PictureRegion(const Camera& camera, int width, int height, double margin)
    : width_(width),
      height_(height),
      margin_(static_cast<float>(margin)),
      clip_from_world_(ClipFromWorld(camera, width, height)),
      cells_(width, height) {}

void PictureRegion::AddEverything() {
  is_everything_ = true;
  cells_.AddEverything();
}

bool PictureRegion::Find(const Eigen::Vector4f& clip, Place& place) const {
  constexpr float kNearest = 1e-4f;  // m
  if (!(clip.w() > kNearest)) return false;
  place.x = (0.5f + 0.5f * clip.x() / clip.w()) * static_cast<float>(width_);
  place.y = (0.5f - 0.5f * clip.y() / clip.w()) * static_cast<float>(height_);
  return std::isfinite(place.x) && std::isfinite(place.y);
}

void PictureRegion::AddAround(float left, float top, float right, float bottom) {
  const auto pixel = [](float place, int size) {  // -1 and `size`: outside
    return static_cast<int>(std::clamp(place, -1.0f, static_cast<float>(size)) + 1) - 1;
  };
  const int x = pixel(left - margin_, width_), y = pixel(top - margin_, height_);
  cells_.Add(
      {x, y, pixel(right + margin_, width_) - x + 1, pixel(bottom + margin_, height_) - y + 1});
}

void PictureRegion::AddBox(const Eigen::AlignedBox3f& box, const Eigen::Matrix4f& world_from_box,
                           float around_px) {
  if (is_everything_ || box.isEmpty()) return;
  const Eigen::Matrix4f clip_from_box = clip_from_world_ * world_from_box;
  Place least{INFINITY, INFINITY}, most{-INFINITY, -INFINITY};
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3f corner = box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(i));
    Place place;
    if (!Find(clip_from_box * corner.homogeneous(), place)) return AddEverything();
    least = {std::min(least.x, place.x), std::min(least.y, place.y)};
    most = {std::max(most.x, place.x), std::max(most.y, place.y)};
  }
  AddAround(least.x - around_px, least.y - around_px, most.x + around_px, most.y + around_px);
}

bool PictureRegion::FindAll(const std::vector<Eigen::Vector3f>& positions) {
  if (is_everything_) return false;
  places_.resize(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (Find(clip_from_world_ * positions[i].homogeneous(), places_[i])) continue;
    AddEverything();
    return false;
  }
  return true;
}

void PictureRegion::AddTriangle(std::size_t a, std::size_t b, std::size_t c) {
  const Place &first = places_[a], &second = places_[b], &third = places_[c];
  AddAround(std::min({first.x, second.x, third.x}), std::min({first.y, second.y, third.y}),
            std::max({first.x, second.x, third.x}), std::max({first.y, second.y, third.y}));
}

void PictureRegion::AddTriangles(const std::vector<Eigen::Vector3f>& positions,
                                 const std::vector<std::uint32_t>& corners) {
  if (!FindAll(positions)) return;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    AddTriangle(corners[i], corners[i + 1], corners[i + 2]);
  }
}

}  // namespace kinescope::render
