#include "render/shape/visible_lines.h"

#include <algorithm>
#include <cmath>

namespace kinescope::render {
namespace {

// m: lines are before the surface that they are on, and outlines are next to it.
constexpr double kNearer = 0.006, kOutlineNearer = 0.012;
constexpr double kBeside = 0.0015;  // m, from an outline to the last triangle that is seen
constexpr double kStep = 1.5;       // px between samples
// Shorter gaps in a line are closed: samples, and of an outline m, less than a finger is wide.
constexpr std::size_t kGap = 3;
constexpr double kGapOfOutline = 0.008;
// Shorter lines are left out: of the picture's height, and outlines of lips and knuckles, m.
constexpr double kShortest = 0.008, kShortestOfFace = 0.003;
constexpr double kSmallestOutline = 0.025;
constexpr double kFlatness = 0.12;  // px, by which a drawn line may miss its samples

using Point = std::pair<double, double>;

double Distance(const Point& a, const Point& b) {
  return std::hypot(a.first - b.first, a.second - b.second);
}

double DistanceToLine(const Point& p, const Point& a, const Point& b) {
  const double length = Distance(a, b);
  if (length < 1e-9) return Distance(p, a);
  return std::abs((b.first - a.first) * (p.second - a.second) -
                  (b.second - a.second) * (p.first - a.first)) /
         length;
}

// Marks the points that are needed between `first` and `last` (Douglas and Peucker, 1973).
void Keep(const std::vector<Point>& points, std::size_t first, std::size_t last,
          std::vector<bool>& is_kept) {
  std::vector<std::pair<std::size_t, std::size_t>> open = {{first, last}};
  while (!open.empty()) {
    const auto [from, to] = open.back();
    open.pop_back();
    double farthest = kFlatness;
    std::size_t at = from;
    for (std::size_t i = from + 1; i < to; ++i) {
      const double distance = DistanceToLine(points[i], points[from], points[to]);
      if (distance > farthest) farthest = distance, at = i;
    }
    if (at == from) continue;
    is_kept[at] = true;
    open.emplace_back(from, at);
    open.emplace_back(at, to);
  }
}

// Along the view axis, of a depth that OpenGL has drawn.
double MetresOf(double depth, const Camera& camera) {
  const double range = camera.far_m - camera.near_m;
  if (camera.is_orthographic()) return camera.near_m + depth * range;
  return camera.near_m * camera.far_m / (camera.far_m - depth * range);
}

std::vector<Point> Simplified(const std::vector<Point>& points) {
  std::vector<bool> is_kept(points.size(), false);
  const std::size_t last = points.size() - 1, middle = last / 2;  // a loop has no length
  for (const std::size_t corner : {std::size_t{0}, middle, last}) is_kept[corner] = true;
  Keep(points, 0, middle, is_kept);
  Keep(points, middle, last, is_kept);
  std::vector<Point> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_kept[i]) kept.push_back(points[i]);
  }
  return kept;
}

}  // namespace

VisibleLines::VisibleLines(const std::vector<SpaceLine>& lines, const Camera& camera, int width,
                           int height)
    : camera_(camera) {
  for (const SpaceLine& each : lines) {
    const bool is_outline = each.kind == LineKind::kOutline;
    const double nearer = is_outline ? kOutlineNearer : kNearer;
    Track track{{}, each.kind, each.line.is_loop};
    track.gap = kGap;
    track.shortest = (each.kind == LineKind::kFace ? kShortestOfFace : kShortest) * height;
    const auto sample = [&](const Eigen::Vector3f& p) -> Sample {
      const Projected at = Project(p.cast<double>(), camera, width, height);
      if (is_outline && at.depth_m >= camera.near_m) {
        track.smallest = std::max(track.smallest, kSmallestOutline * at.px_per_m);
        track.beside = std::max(track.beside, kBeside * at.px_per_m);
        const double gap = std::min(kGapOfOutline * at.px_per_m / kStep, 1000.0);
        track.gap = std::max(track.gap, static_cast<std::size_t>(gap));
      }
      return {at.x_px, at.y_px, at.depth_m - nearer};
    };
    const auto& points = each.line.points;
    const std::size_t ends = points.size() + (each.line.is_loop ? 1 : 0);
    for (std::size_t i = 0; i < ends; ++i) {
      const Sample next = sample(points[i % points.size()]);
      if (!track.samples.empty()) {
        const Sample from = track.samples.back();
        const double length = std::hypot(next.x - from.x, next.y - from.y);
        const int steps = static_cast<int>(std::min(length / kStep, 1000.0));
        for (int step = 1; step < steps; ++step) {
          const double t = static_cast<double>(step) / steps;
          track.samples.push_back({from.x + t * (next.x - from.x), from.y + t * (next.y - from.y),
                                   from.depth_m + t * (next.depth_m - from.depth_m)});
        }
      }
      track.samples.push_back(next);
    }
    tracks_.push_back(std::move(track));
  }
}

void VisibleLines::Judge(const Tile& part, int supersample, const std::vector<float>& depth) {
  const int columns = part.width * supersample, rows = part.height * supersample;
  const auto farthest_near = [&](int x, int y, int reach) {
    float farthest = 0;
    for (int row = std::max(0, y - reach); row <= std::min(rows - 1, y + reach); ++row) {
      const int last = std::min(columns - 1, x + reach);
      for (int column = std::max(0, x - reach); column <= last; ++column) {
        farthest = std::max(
            farthest, depth[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                            static_cast<std::size_t>(column)]);
      }
    }
    return MetresOf(farthest, camera_);
  };
  constexpr int kFarthest = 8;  // samples
  for (Track& track : tracks_) {
    const int reach =
        std::clamp(static_cast<int>(std::min(supersample * track.beside, 100.0)), 1, kFarthest);
    for (Sample& sample : track.samples) {
      const double x = (sample.x - part.x) * supersample;
      const double y = rows - (sample.y - part.y) * supersample;
      const bool is_inside = x >= 0 && x < columns && y >= 0 && y < rows;
      if (!is_inside || sample.depth_m < camera_.near_m) continue;
      sample.is_seen =
          sample.depth_m <= farthest_near(static_cast<int>(x), static_cast<int>(y), reach);
    }
  }
}

std::vector<DrawnLine> VisibleLines::Take() const {
  std::vector<DrawnLine> lines;
  for (const Track& track : tracks_) {
    // A loop begins where it is hidden, so that no seen part of it is cut.
    const auto& samples = track.samples;
    std::size_t first = 0;
    while (track.is_loop && first < samples.size() && samples[first].is_seen) ++first;
    if (first == samples.size()) first = 0;
    std::vector<Point> run;
    std::size_t hidden = 0;
    const auto end_run = [&] {
      double length = 0, extent = 0;
      for (std::size_t i = 1; i < run.size(); ++i) {
        length += Distance(run[i - 1], run[i]);
        extent = std::max(extent, Distance(run[0], run[i]));
      }
      if (run.size() > 1 && length >= track.shortest && extent >= track.smallest) {
        lines.push_back({Simplified(run), track.kind});
      }
      run.clear();
    };
    std::vector<Point> gap;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Sample& sample = samples[(first + i) % samples.size()];
      if (sample.is_seen) {
        run.insert(run.end(), gap.begin(), gap.end());
        gap.clear();
        run.emplace_back(sample.x, sample.y);
        hidden = 0;
        continue;
      }
      if (!run.empty() && ++hidden <= track.gap) {
        gap.emplace_back(sample.x, sample.y);
        continue;
      }
      gap.clear();
      end_run();
    }
    end_run();
  }
  return lines;
}

}  // namespace kinescope::render
