#include "urdf/skin/make/follow.h"

#include <set>

#include "urdf/skin/make/neighbours.h"
#include "urdf/skin/make/solid.h"

namespace kinescope::skin {
namespace {

Build Between(const Build& from, const Build& to, double share) {
  return {Mix(from.woman, to.woman, share), Mix(from.heavy, to.heavy, share)};
}

// How far the vertices around one have come from `start`, on average.
Point MeanWay(const std::vector<Point>& vertices, const std::vector<Point>& start,
              const std::vector<std::uint16_t>& those) {
  Point sum = Point::Zero();
  for (const std::uint16_t other : those) sum += vertices[other] - start[other];
  return sum / static_cast<double>(those.size());
}

Point NormalOf(const std::vector<Point>& vertices, const Triangle& t) {
  const Point& a = vertices[t[0]];
  return (vertices[t[1]] - a).cross(vertices[t[2]] - a).normalized();
}

// Where two limbs have grown together, vertices leave the surface rather than turn a triangle over.
void TurnBack(const std::vector<Point>& start, const std::vector<Triangle>& triangles,
              const Neighbours& around, std::vector<Point>& vertices) {
  constexpr int kMostPasses = 200;
  constexpr double kTurned = 0.25;  // cosine of the angle between the normals, before and after
  for (int pass = 0; pass < kMostPasses; ++pass) {
    std::set<std::uint16_t> turned;
    for (const Triangle& triangle : triangles) {
      if (NormalOf(start, triangle).dot(NormalOf(vertices, triangle)) >= kTurned) continue;
      turned.insert(triangle.begin(), triangle.end());
    }
    if (turned.empty()) return;
    const std::set<std::uint16_t> seeds = turned;
    for (const std::uint16_t i : seeds) turned.insert(around[i].begin(), around[i].end());
    std::vector<Point> moved = vertices;
    for (const std::uint16_t i : turned) moved[i] = start[i] + MeanWay(vertices, start, around[i]);
    vertices.swap(moved);
  }
}

}  // namespace

std::vector<Point> Follow(std::vector<Point> vertices, const Build& from, const Build& to) {
  constexpr int kSteps = 10;
  for (int step = 1; step <= kSteps; ++step) {
    const BodySolid body(Between(from, to, static_cast<double>(step) / kSteps));
    for (Point& p : vertices) {
      p -= body(p) * body.Normal(p);
      if (step == kSteps) p -= body(p) * body.Normal(p);
    }
  }
  return vertices;
}

std::vector<Point> FollowTogether(const std::vector<Point>& start,
                                  const std::vector<Triangle>& triangles, const Build& from,
                                  const Build& to) {
  constexpr int kSteps = 20, kRelaxations = 40;
  const Neighbours around = NeighboursOf(start.size(), triangles);
  std::vector<Point> vertices = start, moved = start, normals = start;
  for (int step = 1; step <= kSteps; ++step) {
    const BodySolid body(Between(from, to, static_cast<double>(step) / kSteps));
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      normals[i] = body.Normal(vertices[i]);
      vertices[i] -= body(vertices[i]) * normals[i];
    }
    for (int relaxation = 0; relaxation < kRelaxations; ++relaxation) {
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        const Point more = start[i] + MeanWay(vertices, start, around[i]) - vertices[i];
        moved[i] = vertices[i] + 0.5 * (more - more.dot(normals[i]) * normals[i]);
      }
      vertices.swap(moved);
    }
    for (Point& p : vertices) p -= body(p) * body.Normal(p);
  }
  TurnBack(start, triangles, around, vertices);
  return vertices;
}

}  // namespace kinescope::skin
