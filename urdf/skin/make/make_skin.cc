// Makes urdf/skin/skin.bin, the skin of all people: meshes the body's rest shape (CGAL),
// moves the mesh to the other builds, and gives each vertex its weights.
//   make_skin FILE
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/facets_in_complex_3_to_triangle_mesh.h>
#include <CGAL/make_mesh_3.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <numeric>
#include <utility>

#include "urdf/skin/make/body_solid.h"
#include "urdf/skin/make/follow.h"
#include "urdf/skin/make/weights.h"
#include "urdf/skin/occlusion.h"
#include "urdf/skin/skin_template.h"

namespace {

using kinescope::skin::BindPose;
using kinescope::skin::BodySolid;
using kinescope::skin::Build;
using kinescope::skin::Point;
using kinescope::skin::SkinTemplate;
using kinescope::skin::Triangle;
using kinescope::skin::VertexWeights;
namespace urdf = kinescope::urdf;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Domain = CGAL::Labeled_mesh_domain_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;

// The length of edges: fine where the surface is, or will be bent.
class EdgeLength {
 public:
  using FT = double;
  using Point_3 = Kernel::Point_3;
  using Index = Domain::Index;

  explicit EdgeLength(const BindPose& bind) {
    const auto near = [&](int segment, const Point& offset, double inner, double outer,
                          double length) {
      const urdf::Pose& link = bind.links[urdf::At(segment)];
      places_.push_back({link.position + link.orientation * offset, inner, outer, length});
    };
    near(urdf::kLeftHand, {0, 0, -0.10}, 0.11, 0.16, 0.0050);
    near(urdf::kLeftForeArm, {0, 0, 0}, 0.07, 0.12, 0.0085);
    near(urdf::kLeftForeArm, {-0.03, 0, 0}, 0.03, 0.06, 0.0065);
    near(urdf::kLeftUpperArm, {0, 0, 0}, 0.10, 0.20, 0.010);
    near(urdf::kLeftUpperArm, {0, -0.06, -0.075}, 0.06, 0.12, 0.0080);
    near(urdf::kLeftLowerLeg, {0, 0, 0}, 0.09, 0.16, 0.010);
    near(urdf::kLeftLowerLeg, {0.05, 0, 0}, 0.03, 0.06, 0.0070);
    near(urdf::kLeftUpperLeg, {0, 0, 0}, 0.12, 0.22, 0.012);
    near(urdf::kLeftUpperLeg, {0.08, -0.01, 0}, 0.06, 0.11, 0.0090);
    near(urdf::kLeftUpperLeg, {-0.06, -0.03, -0.07}, 0.08, 0.14, 0.0095);
    near(urdf::kLeftFoot, {0, 0, -0.05}, 0.16, 0.20, 0.010);
    near(urdf::kHead, {0, 0, 0.08}, 0.16, 0.22, 0.010);
    near(urdf::kHead, {0.10, 0, 0.035}, 0.036, 0.14, 0.0026);
    near(urdf::kHead, {-0.01, 0.078, 0.062}, 0.03, 0.09, 0.0045);
  }

  double operator()(const Point_3& at, int /*dimension*/, const Index& /*index*/) const {
    const Point p(at.x(), std::abs(at.y()), at.z());
    double length = kCoarse;
    for (const Place& place : places_) {
      const double away = kinescope::skin::Ramp(place.inner, place.outer, (p - place.at).norm());
      length = std::min(length, kinescope::skin::Mix(place.length, kCoarse, away));
    }
    return length;
  }

 private:
  static constexpr double kCoarse = 0.0165;  // m
  struct Place {
    Point at;
    double inner, outer;  // between them the length grows to kCoarse, m
    double length;
  };
  std::vector<Place> places_;
};

struct Surface {
  std::vector<Point> vertices;
  std::vector<VertexWeights> sorted;
  std::vector<Triangle> triangles;
};

Surface MeshOf(const BodySolid& body) {
  namespace parameters = CGAL::parameters;
  constexpr double kReach = 1.3;         // m, around the whole body
  constexpr double kFarthest = 0.0005;   // m, of the surface from the triangles
  constexpr double kSmallestAngle = 25;  // degrees
  const auto value = [&](const Kernel::Point_3& p) { return body(Point(p.x(), p.y(), p.z())); };
  const Domain domain = Domain::create_implicit_mesh_domain(
      value, Kernel::Sphere_3(Kernel::Point_3(0, 0, 0.1), kReach * kReach),
      parameters::relative_error_bound = 1e-6);
  const EdgeLength length(body.bind());
  const CGAL::Mesh_criteria_3<Triangulation> criteria(parameters::facet_angle = kSmallestAngle,
                                                      parameters::facet_size = length,
                                                      parameters::facet_distance = kFarthest);
  const auto complex = CGAL::make_mesh_3<Complex>(domain, criteria, parameters::no_exude(),
                                                  parameters::no_perturb(), parameters::manifold());
  CGAL::Surface_mesh<Kernel::Point_3> mesh;
  CGAL::facets_in_complex_3_to_triangle_mesh(complex, mesh);
  Surface surface;
  for (const auto vertex : mesh.vertices()) {
    const auto& p = mesh.point(vertex);
    surface.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto face : mesh.faces()) {
    Triangle triangle{};
    std::size_t corner = 0;
    for (const auto vertex : vertices_around_face(mesh.halfedge(face), mesh)) {
      triangle[corner++] = static_cast<std::uint16_t>(vertex);
    }
    surface.triangles.push_back(triangle);
  }
  return surface;
}

// So that the vertices of a limb follow each other.
void SortByLimb(Surface& surface, std::vector<VertexWeights>& weights) {
  std::vector<std::uint16_t> order(surface.vertices.size()), place(order.size());
  std::iota(order.begin(), order.end(), std::uint16_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::uint16_t a, std::uint16_t b) {
    return LimbOf(weights[a]) < LimbOf(weights[b]);
  });
  std::vector<Point> vertices;
  std::vector<VertexWeights> sorted;
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[order[i]] = static_cast<std::uint16_t>(i);
    vertices.push_back(surface.vertices[order[i]]);
    sorted.push_back(weights[order[i]]);
  }
  surface.vertices = std::move(vertices);
  weights = std::move(sorted);
  for (Triangle& triangle : surface.triangles) {
    for (std::uint16_t& corner : triangle) corner = place[corner];
  }
}

// So that triangles that share vertices follow each other: a renderer shades each vertex once.
void SortForCache(Surface& surface) {
  std::uint16_t* const corners = surface.triangles.front().data();
  meshopt_optimizeVertexCache(corners, corners, 3 * surface.triangles.size(),
                              surface.vertices.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "make_skin FILE\n");
    return 2;
  }
  constexpr Build kMiddle{0.5, 0};
  const BodySolid middle(kMiddle);
  Surface surface = MeshOf(middle);
  const std::size_t count = surface.vertices.size();
  const bool is_one_piece =
      count + surface.triangles.size() == surface.triangles.size() * 3 / 2 + 2;
  if (!is_one_piece || count > 0xffff) {
    std::fprintf(stderr, "make_skin: %zu vertices and %zu triangles are not one closed body\n",
                 count, surface.triangles.size());
    return 1;
  }
  SkinTemplate skin;
  skin.weights = MakeWeights(middle, surface.vertices, surface.triangles);
  SortByLimb(surface, skin.weights);
  SortForCache(surface);
  for (std::size_t corner = 0; corner < SkinTemplate::kCorners; ++corner) {
    const Build lean{static_cast<double>(corner % 2), 0};
    std::vector<Point> vertices = kinescope::skin::Follow(surface.vertices, kMiddle, lean);
    if (corner >= 2) {
      vertices = kinescope::skin::FollowTogether(vertices, surface.triangles, lean,
                                                 {lean.woman, kinescope::skin::kHeaviest});
    }
    for (const Point& p : vertices) {
      skin.corners[corner].push_back(p.cast<float>());
    }
  }
  skin.triangles = surface.triangles;
  std::ofstream file(argv[1], std::ios::binary);
  file << ToBytes(skin);
  file.close();
  if (!file) {
    std::fprintf(stderr, "make_skin: cannot write %s\n", argv[1]);
    return 1;
  }
}
