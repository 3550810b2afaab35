#include "render/shape/smooth_line.h"

#include <utility>

namespace kinescope::render {
namespace {

using Eigen::Vector3f;

// Points at equal distances along `line`; of an open line with both ends.
std::vector<Vector3f> Resampled(const SurfaceLine& line, std::size_t pieces) {
  const std::vector<Vector3f>& points = line.points;
  const double step = LengthOf(line) / static_cast<double>(pieces);
  std::vector<Vector3f> even = {points.front()};
  double walked = 0;  // to points[i]
  for (std::size_t i = 0; even.size() < pieces && i < points.size(); ++i) {
    const Vector3f& from = points[i];
    const Vector3f& to = points[(i + 1) % points.size()];
    const double length = (to - from).norm();
    while (even.size() < pieces && step * static_cast<double>(even.size()) <= walked + length) {
      const double t = (step * static_cast<double>(even.size()) - walked) / length;
      even.push_back(from + static_cast<float>(t) * (to - from));
    }
    walked += length;
  }
  if (!line.is_loop) even.push_back(points.back());
  return even;
}

}  // namespace

double LengthOf(const SurfaceLine& line) {
  double length = 0;
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    length += (line.points[i] - line.points[i - 1]).norm();
  }
  return line.is_loop ? length + (line.points.front() - line.points.back()).norm() : length;
}

SurfaceLine Smoothed(const SurfaceLine& line, double wave) {
  // Forth and back, so that nothing shrinks (Taubin, 1995): halves waves of kWave steps.
  constexpr float kForth = 0.5f, kBack = -0.53f;
  constexpr int kPasses = 40;
  constexpr double kWave = 6.6;
  const auto pieces = static_cast<std::size_t>(LengthOf(line) / wave * kWave);
  if (pieces < 4) return line;
  SurfaceLine smooth{Resampled(line, pieces), line.is_loop};
  std::vector<Vector3f>& points = smooth.points;
  const std::size_t count = points.size(), first = line.is_loop ? 0 : 1, end = count - first;
  std::vector<Vector3f> before(count);
  for (int pass = 0; pass < kPasses; ++pass) {
    std::swap(before, points);
    points.front() = before.front();
    points.back() = before.back();
    const float share = pass % 2 == 0 ? kForth : kBack;
    for (std::size_t i = first; i < end; ++i) {
      const Vector3f& last = before[i > 0 ? i - 1 : count - 1];
      const Vector3f& next = before[i + 1 < count ? i + 1 : 0];
      points[i] = (1 - share) * before[i] + 0.5f * share * (last + next);
    }
  }
  return smooth;
}

}  // namespace kinescope::render
