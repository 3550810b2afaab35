#include <algorithm>
#include <cmath>

#include "core/system/check.h"
#include "render/plot.h"

namespace kinescope::render {
namespace {

using Point = std::pair<double, double>;

}  // namespace

std::vector<double> NiceTicks(double from, double to, int most) {
  KINESCOPE_CHECK(from < to && most >= 1);
  const double rough = (to - from) / most;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * (1 - 1e-9)) {
      step = factor * power;
      break;
    }
  }
  std::vector<double> ticks;
  for (double k = std::ceil(from / step - 1e-9); k * step <= to + 1e-9 * step; ++k) {
    ticks.push_back(k * step);
  }
  return ticks;
}

std::vector<Point> Thinned(const std::vector<Point>& points, double from, double to, int columns) {
  if (points.size() <= 4 * static_cast<std::size_t>(columns)) return points;
  std::vector<Point> thin;
  const auto column_of = [&](double x) { return std::floor((x - from) / (to - from) * columns); };
  for (std::size_t begin = 0; begin < points.size();) {
    if (std::isnan(points[begin].second)) {
      if (thin.empty() || !std::isnan(thin.back().second)) thin.push_back(points[begin]);
      ++begin;
      continue;
    }
    const double column = column_of(points[begin].first);
    std::size_t end = begin, low = begin, high = begin;
    for (; end < points.size() && !std::isnan(points[end].second) &&
           column_of(points[end].first) == column;
         ++end) {
      if (points[end].second < points[low].second) low = end;
      if (points[end].second > points[high].second) high = end;
    }
    const std::size_t kept[] = {begin, std::min(low, high), std::max(low, high), end - 1};
    for (std::size_t i = 0; i < 4; ++i) {
      if (i == 0 || kept[i] != kept[i - 1]) thin.push_back(points[kept[i]]);
    }
    begin = end;
  }
  return thin;
}

}  // namespace kinescope::render
