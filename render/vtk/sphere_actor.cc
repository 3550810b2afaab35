#include "render/vtk/sphere_actor.h"

#include <cmath>
#include <string>

#include "core/system/check.h"
#include "render/camera/camera_matrices.h"

namespace kinescope::render {
namespace {

// Radii by which a sphere counts as nearer than its centre when it meets body and other spheres. A
// joint's sphere is only little thicker than the limb around it: without this it would be cut up by
// skin and clothes. One depth for the whole sphere: it is in front as a whole, or shines through.
constexpr float kTowardsEye = 2.0f;

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

urdf::Mesh AllDomes() {
  urdf::Mesh all;
  const urdf::Mesh dome = DomeMesh();
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
  vec4 nearer = MCDCMatrix * vec4(ball.xyz + towardsEye * ball.w * toEye, 1.0);
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
uniform int ballCount;
uniform vec3 eye;
uniform float sphereOpacity;
)";
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
  for (int i = 0; i < ballCount; ++i) {
    vec3 center = balls[i].xyz - eye;
    float along = dot(center, ray);
    vec3 off = center - along * ray;
    bool isCovered = along < mine && dot(off, off) < balls[i].w * balls[i].w;
    isNearest = isCovered && i != whichVS ? 0.0 : isNearest;
  }
  gl_FragData[0].a *= isNearest;
)";
  text.fragment = pass == Pass::kGhost ? color + only_nearest : color;
  return text;
}

}  // namespace

SphereActor::SphereActor(Pass pass, double opacity) : shaded_(pass, SphereText(pass)) {
  shaded_.SetMesh(AllDomes());
  shaded_.uniforms().SetUniformf("sphereOpacity", static_cast<float>(opacity));
  shaded_.uniforms().SetUniformf("towardsEye", kTowardsEye);
  Show({}, Camera());
}

void SphereActor::Show(const std::vector<SphereLook>& spheres, const Camera& camera) {
  KINESCOPE_CHECK(spheres.size() <= kSphereCapacity);
  float balls[kSphereCapacity][4] = {};
  float looks[kSphereCapacity][4] = {};
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      balls[i][axis] = static_cast<float>(spheres[i].center[static_cast<Eigen::Index>(axis)]);
      looks[i][axis] = static_cast<float>(spheres[i].color[axis]);
    }
    balls[i][3] = static_cast<float>(spheres[i].radius);
    looks[i][3] = static_cast<float>(spheres[i].rim);
  }
  vtkUniforms& uniforms = shaded_.uniforms();
  uniforms.SetUniform4fv("balls", kSphereCapacity, balls);
  uniforms.SetUniformi("ballCount", static_cast<int>(spheres.size()));
  uniforms.SetUniform4fv("looks", kSphereCapacity, looks);
  // Without perspective all rays are parallel: nearly so from an eye far behind the camera, and
  // near enough for a float.
  constexpr double kFarEye = 1000;  // m
  const Eigen::Vector3d back = (camera.position - camera.target).normalized();
  const double behind = camera.is_orthographic() ? kFarEye : 0;
  const Eigen::Vector3f eye = (camera.position + behind * back).cast<float>();
  uniforms.SetUniform3f("eye", eye.data());
  const glm::dmat4 view = ViewFromWorld(camera);
  const float up[] = {static_cast<float>(view[0][1]), static_cast<float>(view[1][1]),
                      static_cast<float>(view[2][1])};
  uniforms.SetUniform3f("cameraUp", up);
}

}  // namespace kinescope::render
