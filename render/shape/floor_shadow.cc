#include "render/shape/floor_shadow.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace kinescope::render {
namespace {

constexpr float kMargin = 0.45f;       // m, around the limbs
constexpr float kFading = 0.33f;       // m, over which it ends
constexpr float kAboveFloor = 0.002f;  // m
constexpr float kDarkest = 0.8f, kUnseen = 0.01f;
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

// The first `count` of a run of pixels. Alpha stays.
void Blend(const std::array<float, FloorShadow::kRun>& shades, const std::array<float, 4>& dark,
           std::size_t count, std::uint8_t* rgba) {
  constexpr float kHalf = 0.5f;  // a level, so that levels are rounded
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t channel = 0; channel < 4; ++channel) {
      const auto lit = static_cast<float>(rgba[4 * i + channel]);
      const float by = channel == 3 ? 0 : shades[i];
      rgba[4 * i + channel] =
          static_cast<std::uint8_t>(static_cast<int>(lit + by * (dark[channel] - lit) + kHalf));
    }
  }
}

// From the line within the nearest limb, seen from above, m.
float DistanceFrom(const skin::Capsules& limbs, const Eigen::Vector3f& point) {
  float least = std::numeric_limits<float>::infinity();  // squared
  for (const skin::Capsule& limb : limbs) {
    const Eigen::Vector2f bone = (limb.end - limb.start).head<2>();
    const Eigen::Vector2f away = (point - limb.start).head<2>();
    constexpr float kPoint = 1e-8f;  // m², of a bone that stands upright
    const float along =
        std::clamp(away.dot(bone) / std::max(bone.squaredNorm(), kPoint), 0.0f, 1.0f);
    least = std::min(least, (away - along * bone).squaredNorm());
  }
  return std::sqrt(least);
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
  for (std::size_t i = 0; i < points_.size(); ++i) {
    // As if light came from the cloudy part of the sky only: it makes the shadow three times as
    // deep. It ends before the points do.
    const float open = shade_[i];
    const float left =
        std::clamp((kMargin - DistanceFrom(limbs, points_[i])) / kFading, 0.0f, 1.0f);
    shade_[i] = std::max(0.0f, kDarkest * (1 - open * open * open) * left * left - kUnseen);
  }
  FindShade();
}

// As far as the points beside those with shade.
void FloorShadow::FindShade() {
  least_ = {kSide, kSide};
  most_ = {-1, -1};
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      if (shade_[static_cast<std::size_t>(row) * kSide + static_cast<std::size_t>(column)] <= 0)
        continue;
      const std::array<int, 2> here = {column, row};
      for (std::size_t axis = 0; axis < 2; ++axis) {
        least_[axis] = std::min(least_[axis], std::max(0, here[axis] - 1));
        most_[axis] = std::max(most_[axis], std::min(kSide - 1, here[axis] + 1));
      }
    }
  }
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
  const Eigen::Vector3d each = points.col(0);
  const std::array<float, 4> dark = {static_cast<float>(255 * color[0]),
                                     static_cast<float>(255 * color[1]),
                                     static_cast<float>(255 * color[2]), 0};
  for (int y = within.y; y < within.y + within.height; ++y) {
    const auto at = [&](double x) -> Eigen::Vector3d {
      return points * Eigen::Vector3d(x + 0.5, y + 0.5, 1);
    };
    double from = within.x, to = within.x + within.width;
    const Eigen::Vector3d zero = at(0);
    for (int axis = 0; axis < 2; ++axis) {
      const double least = least_[static_cast<std::size_t>(axis)];
      const double most = most_[static_cast<std::size_t>(axis)];
      KeepPositive(zero[axis] - least * zero[2], each[axis] - least * each[2], from, to);
      KeepPositive(most * zero[2] - zero[axis], most * each[2] - each[axis], from, to);
    }
    KeepPositive(zero[2], each[2], from, to);
    if (!(from < to)) continue;
    const int first = static_cast<int>(std::ceil(from)), end = static_cast<int>(std::ceil(to));
    MarkChanged(image, {first, y, end - first, 1});
    for (int run = first - first % kRun; run < end; run += kRun) {
      Shades shades = ShadesOf(at(run).cast<float>(), each.cast<float>());
      for (int i = 0; i < kRun; ++i) {
        if (run + i < first || run + i >= end) shades[static_cast<std::size_t>(i)] = 0;
      }
      const auto count = static_cast<std::size_t>(std::min(kRun, image.width - run));
      Blend(shades, dark, count,
            image.rgba.data() + 4 * (static_cast<std::ptrdiff_t>(y) * image.width + run));
    }
  }
}

// Of pixels beside each other, from `start` in steps of `along`: column and row, times depth, and
// that.
FloorShadow::Shades FloorShadow::ShadesOf(const Eigen::Vector3f& start,
                                          const Eigen::Vector3f& along) const {
  constexpr float kLast = static_cast<float>(kSide - 1) - 1e-4f;
  std::array<int, kRun> places;
  std::array<float, kRun> right, below;
  for (std::size_t i = 0; i < kRun; ++i) {
    const auto steps = static_cast<float>(i);
    const float depth = start[2] + steps * along[2];
    // Rounding may lead out of the points; 0 of what is not a number.
    const float column = std::min(kLast, std::max(0.0f, (start[0] + steps * along[0]) / depth));
    const float row = std::min(kLast, std::max(0.0f, (start[1] + steps * along[1]) / depth));
    const int left = static_cast<int>(column), above = static_cast<int>(row);
    places[i] = above * kSide + left;
    right[i] = column - static_cast<float>(left);
    below[i] = row - static_cast<float>(above);
  }
  Shades shades;
  for (std::size_t i = 0; i < kRun; ++i) {
    const float* const near = shade_.data() + places[i];
    const float upper = near[0] + right[i] * (near[1] - near[0]);
    const float lower = near[kSide] + right[i] * (near[kSide + 1] - near[kSide]);
    shades[i] = upper + below[i] * (lower - upper);
  }
  return shades;
}

}  // namespace kinescope::render
