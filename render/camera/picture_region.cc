#include "render/camera/picture_region.h"

#include <algorithm>
#include <cmath>

#include "render/camera/camera_matrices.h"

namespace kinescope::render {
namespace {

constexpr int CellsOf(int pixels) {
  return (pixels + PictureRegion::kCell - 1) / PictureRegion::kCell;
}

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
      columns_(CellsOf(width)),
      rows_(CellsOf(height)),
      clip_from_world_(ClipFromWorld(camera, width, height)),
      cells_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

void PictureRegion::AddEverything() {
  is_everything_ = true;
  std::fill(cells_.begin(), cells_.end(), std::uint8_t{1});
}

bool PictureRegion::Find(const Eigen::Vector4f& clip, Place& place) const {
  constexpr float kNearest = 1e-4f;  // m
  if (!(clip.w() > kNearest)) return false;
  place.x = (0.5f + 0.5f * clip.x() / clip.w()) * static_cast<float>(width_);
  place.y = (0.5f - 0.5f * clip.y() / clip.w()) * static_cast<float>(height_);
  return std::isfinite(place.x) && std::isfinite(place.y);
}

void PictureRegion::AddAround(float left, float top, float right, float bottom) {
  const auto cell = [](float pixel, int count) {
    const float last = static_cast<float>(count * kCell);
    return static_cast<int>(std::clamp(pixel, -1.0f, last) + kCell) / kCell - 1;
  };
  const int first_column = std::max(0, cell(left - margin_, columns_));
  const int last_column = std::min(columns_ - 1, cell(right + margin_, columns_));
  const int first_row = std::max(0, cell(top - margin_, rows_));
  const int last_row = std::min(rows_ - 1, cell(bottom + margin_, rows_));
  for (int row = first_row; row <= last_row; ++row) {
    const auto line = cells_.begin() + static_cast<std::ptrdiff_t>(row) * columns_;
    for (int column = first_column; column <= last_column; ++column) line[column] = 1;
  }
}

void PictureRegion::AddBox(const Eigen::AlignedBox3f& box, const Eigen::Matrix4f& world_from_box) {
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
  AddAround(least.x, least.y, most.x, most.y);
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

std::vector<Tile> PictureRegion::Rectangles() const {
  std::vector<Tile> all;
  std::vector<std::size_t> above, here;  // rectangles that end with the row above, with this row
  for (int row = 0; row < rows_; ++row) {
    here.clear();
    const int y = row * kCell, height = std::min(kCell, height_ - y);
    const auto line = cells_.begin() + static_cast<std::ptrdiff_t>(row) * columns_;
    for (int column = 0; column < columns_; ++column) {
      if (line[column] == 0) continue;
      const int first = column;
      while (column < columns_ && line[column] != 0) ++column;
      const int x = first * kCell, width = std::min(column * kCell, width_) - x;
      const auto same = std::find_if(above.begin(), above.end(), [&](std::size_t each) {
        return all[each].x == x && all[each].width == width;
      });
      if (same != above.end()) {
        all[*same].height += height;
        here.push_back(*same);
      } else {
        here.push_back(all.size());
        all.push_back({x, y, width, height});
      }
    }
    above.swap(here);
  }
  return all;
}

}  // namespace kinescope::render
