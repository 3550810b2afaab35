#include "render/shape/floor_shadow.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace kinescope::render {
namespace {

constexpr float kMargin = 0.45f;       // m, around the limbs
constexpr float kAboveFloor = 0.002f;  // m
constexpr float kDarkest = 0.8f, kUnseen = 0.01f;
constexpr int kRun = 16;  // px, computed from one start; runs begin at multiples of it

// Where a function of a column, a + b * x, is not negative: narrows `from` to `to`.
void KeepPositive(double a, double b, double& from, double& to) {
  const double zero = -a / b;
  if (b > 0) {
    from = std::max(from, zero);
  } else if (b < 0) {
    to = std::min(to, zero);
  } else if (!(a >= 0)) {
    to = from;
  }
}

}  // namespace

FloorShadow::FloorShadow()
    : points_(static_cast<std::size_t>(kSide) * kSide, Eigen::Vector3f::Zero()),
      shade_(points_.size(), 0) {}

void FloorShadow::Cast(const skin::Capsules& limbs) {
  Eigen::Vector2f lowest = limbs.front().start.head<2>(), highest = lowest;
  for (const skin::Capsule& limb : limbs) {
    for (const Eigen::Vector3f& end : {limb.start, limb.end}) {
      lowest = lowest.cwiseMin(end.head<2>());
      highest = highest.cwiseMax(end.head<2>());
    }
  }
  first_ = lowest.array() - kMargin;
  step_ = ((highest - lowest).array() + 2 * kMargin) / (kSide - 1);
  std::size_t at = 0;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      points_[at++] = {first_.x() + static_cast<float>(column) * step_.x(),
                       first_.y() + static_cast<float>(row) * step_.y(), kAboveFloor};
    }
  }
  skin::SetOpenSky(points_, limbs, shade_);
  // It ends before the points do.
  const auto fade = [](int i) {
    const float inside = static_cast<float>(std::min(i, kSide - 1 - i)) / (0.25f * kSide);
    return std::min(1.0f, inside);
  };
  at = 0;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      // As if light came from the cloudy part of the sky only: it makes the shadow three times as
      // deep.
      const float open = shade_[at], left = fade(row) * fade(column);
      shade_[at++] = std::max(0.0f, kDarkest * (1 - open * open * open) * left * left - kUnseen);
    }
  }
}

// A column or row, which rounding may have led out of the points; 0 if it is not a number.
float FloorShadow::Among(float points) {
  return std::min(static_cast<float>(kSide - 1) - 1e-4f, std::max(0.0f, points));
}

void FloorShadow::BlendInto(Image& image, const Tile& within, const Camera& camera,
                            const Rgb& color) const {
  const auto floor_from_picture = PlaneFromPicture(camera, image.width, image.height, kAboveFloor);
  if (!floor_from_picture) return;
  Eigen::Matrix3d points_from_floor = Eigen::Matrix3d::Identity();
  for (int axis = 0; axis < 2; ++axis) {
    points_from_floor(axis, axis) = 1 / static_cast<double>(step_[axis]);
    points_from_floor(axis, 2) = -static_cast<double>(first_[axis]) / step_[axis];
  }
  // Of a pixel: column and row among the points, both times `depth`, and that.
  const Eigen::Matrix3d points = points_from_floor * *floor_from_picture;
  const std::array<float, 3> dark = {static_cast<float>(255 * color[0]),
                                     static_cast<float>(255 * color[1]),
                                     static_cast<float>(255 * color[2])};
  const Eigen::Vector3f along = points.col(0).cast<float>();
  for (int y = within.y; y < within.y + within.height; ++y) {
    const auto at = [&](double x) -> Eigen::Vector3d {
      return points * Eigen::Vector3d(x + 0.5, y + 0.5, 1);
    };
    double from = within.x, to = within.x + within.width;
    const Eigen::Vector3d zero = at(0), each = points.col(0);
    constexpr double kEnd = kSide - 1;
    for (int axis = 0; axis < 2; ++axis) {
      KeepPositive(zero[axis], each[axis], from, to);
      KeepPositive(kEnd * zero[2] - zero[axis], kEnd * each[2] - each[axis], from, to);
    }
    KeepPositive(zero[2], each[2], from, to);
    if (!(from < to)) continue;
    const int first = static_cast<int>(std::ceil(from)), end = static_cast<int>(std::ceil(to));
    for (int run = first - first % kRun; run < end; run += kRun) {
      const Eigen::Vector3f start = at(run).cast<float>();
      std::array<float, kRun> columns, rows;
      for (int i = 0; i < kRun; ++i) {
        const float steps = static_cast<float>(i), depth = start[2] + steps * along[2];
        columns[static_cast<std::size_t>(i)] = (start[0] + steps * along[0]) / depth;
        rows[static_cast<std::size_t>(i)] = (start[1] + steps * along[1]) / depth;
      }
      for (int x = std::max(run, first); x < std::min(run + kRun, end); ++x) {
        const auto i = static_cast<std::size_t>(x - run);
        const float column = Among(columns[i]), row = Among(rows[i]);
        const auto left = static_cast<std::size_t>(column), above = static_cast<std::size_t>(row);
        const float* const near = shade_.data() + above * kSide + left;
        const float right = column - static_cast<float>(left);
        const float upper = near[0] + right * (near[1] - near[0]);
        const float lower = near[kSide] + right * (near[kSide + 1] - near[kSide]);
        const float shade = upper + (row - static_cast<float>(above)) * (lower - upper);
        if (!(shade > 0)) continue;
        std::uint8_t* const pixel =
            image.rgba.data() + 4 * (static_cast<std::ptrdiff_t>(y) * image.width + x);
        for (std::size_t channel = 0; channel < 3; ++channel) {
          const auto lit = static_cast<float>(pixel[channel]);
          pixel[channel] = static_cast<std::uint8_t>(lit + shade * (dark[channel] - lit) + 0.5f);
        }
      }
    }
  }
}

}  // namespace kinescope::render
