#include "render/vtk/sphere_actor.h"

#include <vtkActor.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/system/check.h"
#include "render/camera/camera_matrices.h"

namespace kinescope::render {
namespace {

// Unit dome around +z. Its corners only give outline and depth: normals are computed per pixel.
urdf::Mesh DomeMesh() {
  struct Ring {
    double radius;
    int corners;
  };
  constexpr Ring kRings[] = {{0.72, 10}, {1.0, 40}};
  urdf::Mesh mesh;
  std::uint32_t inner = mesh.AddVertex({0, 0, 1}, Eigen::Vector3f::UnitZ());
  int inner_corners = 1;
  for (const Ring& ring : kRings) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i < ring.corners; ++i) {
      const double angle = 2 * M_PI * i / ring.corners;
      const double height = std::sqrt(std::max(0.0, 1 - ring.radius * ring.radius));
      const Eigen::Vector3f point(static_cast<float>(ring.radius * std::cos(angle)),
                                  static_cast<float>(ring.radius * std::sin(angle)),
                                  static_cast<float>(height));
      mesh.AddVertex(point, point);
    }
    const int ratio = ring.corners / inner_corners;  // all around the pole, then four for one
    for (int i = 0; i < ring.corners; ++i) {
      const auto at = [&](int step) {
        return first + static_cast<std::uint32_t>(step % ring.corners);
      };
      const auto inside = [&](int step) {
        return inner + static_cast<std::uint32_t>(step / ratio % inner_corners);
      };
      mesh.AddTriangle(inside(i), at(i), at(i + 1));
      if (inner_corners > 1 && i % ratio == ratio - 1) {
        mesh.AddTriangle(inside(i), at(i + 1), inside(i + 1));
      }
    }
    inner = first;
    inner_corners = ring.corners;
  }
  return mesh;
}

// In its place where it is small: its rim, filled with as large triangles as possible. llvmpipe
// shades 4 x 4 pixels for a triangle that covers one.
urdf::Mesh DiscMesh() {
  constexpr std::uint32_t kRimCorners = 16;
  urdf::Mesh mesh;
  for (std::uint32_t i = 0; i < kRimCorners; ++i) {
    const double angle = 2 * M_PI * i / kRimCorners;
    const auto x = static_cast<float>(std::cos(angle)), y = static_cast<float>(std::sin(angle));
    mesh.AddVertex({x, y, 0}, {x, y, 0});
  }
  for (std::uint32_t step = 1; step < kRimCorners; step *= 2) {
    for (std::uint32_t i = 0; i + 2 * step <= kRimCorners; i += 2 * step) {
      const std::uint32_t last = (i + 2 * step) % kRimCorners;
      if (i != last) mesh.AddTriangle(i, i + step, last);
    }
  }
  return mesh;
}

urdf::Mesh Each(const urdf::Mesh& dome) {
  urdf::Mesh all;
  for (int i = 0; i < kSphereCapacity; ++i) {
    const std::size_t first = all.positions.size();
    all.Append(dome, Eigen::Affine3d::Identity());
    all.Paint(first, Eigen::Vector4f::Ones(), i);
  }
  return all;
}

ShaderText SphereText(Pass pass) {
  ShaderText text;
  text.vertex_declarations = R"(
flat out int whichVS;
out vec3 domeVS;
out vec3 worldVS;
out float skyVS;
)";
  // The dome's axes are nearly those of the camera, so its own coordinates serve as the normal.
  text.vertex = R"(
  whichVS = int(part + 0.5);
  vec4 ball = balls[whichVS];
  vec3 toEye = normalize(eye - ball.xyz);
  vec3 side = normalize(cross(cameraUp, toEye));
  vec3 above = cross(toEye, side);
  vec3 outward = side * vertexMC.x + above * vertexMC.y + toEye * vertexMC.z;
  vec3 onBall = ball.xyz + ball.w * outward;
  gl_Position = MCDCMatrix * vec4(onBall, 1.0);
  vec4 nearer = MCDCMatrix * vec4(ball.xyz + depths[whichVS] * toEye, 1.0);
  gl_Position.z = nearer.z / nearer.w * gl_Position.w;
  domeVS = vertexMC.xyz;
  worldVS = onBall;
  skyVS = 0.5 + 0.5 * outward.z;
)";
  const std::string capacity = "[" + std::to_string(kSphereCapacity) + "];\n";
  text.fragment_declarations =
      "uniform vec4 balls" + capacity + "uniform vec4 looks" + capacity + R"(
flat in int whichVS;
in vec3 domeVS;
in vec3 worldVS;
in float skyVS;
uniform vec3 eye;
uniform float sphereOpacity;
)";
  if (pass == Pass::kGhost) {
    text.fragment_declarations += "uniform int beside" + capacity + "uniform int besideCount" +
                                  capacity + "uniform int besideList[" +
                                  std::to_string(kSphereCapacity * kSphereCapacity) + "];\n";
  }
  const std::string color = R"(
  vec4 look = looks[whichVS];
  float fromAxis2 = min(dot(domeVS.xy, domeVS.xy), 1.0);
  vec3 normal = vec3(domeVS.xy, sqrt(1.0 - fromAxis2));
  float fromAxis = sqrt(fromAxis2);
  float onRim = abs(look.a) * clamp((fromAxis - 0.76) / fwidth(fromAxis) + 0.5, 0.0, 1.0);
  vec3 rim = look.a > 0.0 ? vec3(0.15, 0.02, 0.02) : vec3(1.0);
  vec3 color = mix(look.rgb, rim, onRim);
  float shine = max(dot(normal, vec3(-0.284, 0.410, 0.867)), 0.0);
  shine *= shine; shine *= shine; shine *= shine; shine *= shine; shine *= shine;
  // Between pure hue and full light: a class must read the same on the dark side.
  color = mix(color, Lit(color, normal, skyVS), 0.75) + vec3(0.28 * shine * (1.0 - onRim));
  gl_FragData[0] = vec4(color, sphereOpacity);
)";
  // Two classes that shine through one another would mix to a third: only the nearest is drawn. By
  // opacity, not discard, so that the depth test still comes before the shader.
  const std::string only_nearest = R"(
  vec3 ray = normalize(worldVS - eye);
  float mine = dot(balls[whichVS].xyz - eye, ray);
  float isNearest = 1.0;
  int others = beside[whichVS];
  for (int n = 0; n < besideCount[whichVS]; ++n) {
    int i = besideList[others + n];
    vec3 center = balls[i].xyz - eye;
    float along = dot(center, ray);
    vec3 off = center - along * ray;
    bool isCovered = along < mine && dot(off, off) < balls[i].w * balls[i].w;
    isNearest = isCovered ? 0.0 : isNearest;
  }
  gl_FragData[0].a *= isNearest;
)";
  text.fragment = pass == Pass::kGhost ? color + only_nearest : color;
  return text;
}

// For each sphere, the others that a ray from the eye may meet, too.
struct Neighbours {
  std::array<int, kSphereCapacity> first{}, count{};
  std::array<int, kSphereCapacity * kSphereCapacity> list{};
};

Neighbours NeighboursOf(const std::vector<SphereLook>& spheres, const Eigen::Vector3d& eye) {
  constexpr double kMore = 0.001;  // rad; the shader computes in floats
  std::array<Eigen::Vector3d, kSphereCapacity> directions;
  std::array<double, kSphereCapacity> reaches{};  // rad
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Eigen::Vector3d away = spheres[i].center - eye;
    const double distance = away.norm();
    directions[i] = away / std::max(distance, 1e-9);
    reaches[i] = distance > spheres[i].radius ? std::asin(spheres[i].radius / distance) : M_PI;
  }
  Neighbours beside;
  int end = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    beside.first[i] = end;
    for (std::size_t j = 0; j < spheres.size(); ++j) {
      const double angle = std::min(reaches[i] + reaches[j] + kMore, M_PI);
      if (j == i || directions[i].dot(directions[j]) < std::cos(angle)) continue;
      beside.list[static_cast<std::size_t>(end++)] = static_cast<int>(j);
    }
    beside.count[i] = end - beside.first[i];
  }
  return beside;
}

}  // namespace

SphereActor::SphereActor(Pass pass, double opacity)
    : pass_(pass), fine_(pass, SphereText(pass)), coarse_(pass, SphereText(pass)) {
  fine_.SetMesh(Each(DomeMesh()));
  coarse_.SetMesh(Each(DiscMesh()));
  for (ShadedActor* domes : {&fine_, &coarse_}) {
    domes->uniforms().SetUniformf("sphereOpacity", static_cast<float>(opacity));
  }
  Show({}, Camera(), true);
  Show({}, Camera(), false);
}

void SphereActor::Show(const std::vector<SphereLook>& spheres, const Camera& camera,
                       bool is_small) {
  KINESCOPE_CHECK(spheres.size() <= kSphereCapacity);
  fine_.actor()->SetVisibility(!is_small && !spheres.empty());
  coarse_.actor()->SetVisibility(is_small && !spheres.empty());
  boxes_.clear();
  for (const SphereLook& sphere : spheres) {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(sphere.radius);
    boxes_.emplace_back((sphere.center - reach).cast<float>(),
                        (sphere.center + reach).cast<float>());
  }
  float balls[kSphereCapacity][4] = {};
  float looks[kSphereCapacity][4] = {};
  float depths[kSphereCapacity] = {};
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      balls[i][axis] = static_cast<float>(spheres[i].center[static_cast<Eigen::Index>(axis)]);
      looks[i][axis] = static_cast<float>(spheres[i].color[axis]);
    }
    balls[i][3] = static_cast<float>(spheres[i].radius);
    looks[i][3] = static_cast<float>(spheres[i].rim);
    depths[i] = static_cast<float>(spheres[i].depth);
  }
  vtkUniforms& uniforms = (is_small ? coarse_ : fine_).uniforms();
  uniforms.SetUniform4fv("balls", kSphereCapacity, balls);
  uniforms.SetUniform4fv("looks", kSphereCapacity, looks);
  uniforms.SetUniform1fv("depths", kSphereCapacity, depths);
  // Without perspective all rays are parallel: nearly so from an eye far behind the camera, and
  // near enough for a float.
  constexpr double kFarEye = 1000;  // m
  const Eigen::Vector3d back = (camera.position - camera.target).normalized();
  const double behind = camera.is_orthographic() ? kFarEye : 0;
  const Eigen::Vector3d eye = camera.position + behind * back;
  const Eigen::Vector3f eye_as_float = eye.cast<float>();
  uniforms.SetUniform3f("eye", eye_as_float.data());
  if (pass_ == Pass::kGhost) {
    const Neighbours beside = NeighboursOf(spheres, eye);
    uniforms.SetUniform1iv("beside", kSphereCapacity, beside.first.data());
    uniforms.SetUniform1iv("besideCount", kSphereCapacity, beside.count.data());
    uniforms.SetUniform1iv("besideList", kSphereCapacity * kSphereCapacity, beside.list.data());
  }
  const glm::dmat4 view = ViewFromWorld(camera);
  const float up[] = {static_cast<float>(view[0][1]), static_cast<float>(view[1][1]),
                      static_cast<float>(view[2][1])};
  uniforms.SetUniform3f("cameraUp", up);
}

void SphereActor::AddTo(PictureRegion& region) const {
  if (!fine_.is_visible() && !coarse_.is_visible()) return;
  for (const Eigen::AlignedBox3f& box : boxes_) region.AddBox(box);
}

}  // namespace kinescope::render
