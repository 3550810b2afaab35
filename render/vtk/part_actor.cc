#include "render/vtk/part_actor.h"

#include "core/system/check.h"

namespace kinescope::render {
namespace {

ShaderText PartText(PartActor::Light light, int part_count) {
  ShaderText text;
  text.vertex_declarations = "out vec4 tintVS;\nout float skyVS;\nout vec2 partVS;\n";
  text.vertex = part_count == 1 ? "  mat4 worldFromPart = worldFromParts[0];\n"
                                : "  mat4 worldFromPart = worldFromParts[int(part + 0.5)];\n";
  text.vertex += R"(
  gl_Position = MCDCMatrix * (worldFromPart * vertexMC);
  vec3 normalWorld = normalize(mat3(worldFromPart) * normalMC + vec3(0.0, 0.0, 1e-20));
  normalVCVSOutput = normalMatrix * normalWorld;
  skyVS = 0.5 + 0.5 * normalWorld.z;
  partVS = vertexMC.xy;
  tintVS = vec4(mix(tint.rgb, overrideColor.rgb, overrideColor.a), tint.a * opacityFactor);
)";
  text.fragment_declarations = "in vec4 tintVS;\nin float skyVS;\nin vec2 partVS;\n";
  switch (light) {
    case PartActor::Light::kLitAtVertices:
      text.vertex_declarations += kLitFunction;
      text.vertex += "  tintVS.rgb = Lit(tintVS.rgb, normalize(normalVCVSOutput), skyVS);\n";
      text.fragment = "gl_FragData[0] = tintVS;\n";
      break;
    case PartActor::Light::kLit:
      text.fragment =
          "gl_FragData[0] = vec4(Lit(tintVS.rgb, normalVCVSOutput, skyVS), tintVS.a);\n";
      break;
    case PartActor::Light::kFlatBelow:
    case PartActor::Light::kBelowThat:
      text.vertex += light == PartActor::Light::kFlatBelow
                         ? "  gl_Position.z += 2.0e-5 * gl_Position.w;\n"
                         : "  gl_Position.z += 4.0e-5 * gl_Position.w;\n";
      [[fallthrough]];
    case PartActor::Light::kFlat: text.fragment = "gl_FragData[0] = tintVS;\n"; break;
    case PartActor::Light::kSoft:
      text.fragment =
          "float inside = max(1.0 - dot(partVS, partVS), 0.0);\n"
          "gl_FragData[0] = vec4(tintVS.rgb, tintVS.a * inside * inside);\n";
      break;
  }
  return text;
}

}  // namespace

PartActor::PartActor(Pass pass, Light light, int part_count)
    : shaded_(pass, PartText(light, part_count)),
      world_from_part_(static_cast<std::size_t>(part_count), Eigen::Matrix4f::Zero()) {
  KINESCOPE_CHECK(part_count >= 1 && part_count <= static_cast<int>(kMaxParts));
  Commit();  // the uniforms' declarations become part of the shader
}

void PartActor::SetMesh(const urdf::Mesh& mesh) {
  boxes_.assign(world_from_part_.size(), Eigen::AlignedBox3f());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const std::size_t part = boxes_.size() == 1 ? 0 : static_cast<std::size_t>(mesh.parts[i]);
    boxes_.at(part).extend(mesh.positions[i]);
  }
  shaded_.SetMesh(mesh);
}

void PartActor::AddTo(PictureRegion& region) const {
  if (!shaded_.is_visible()) return;
  for (std::size_t part = 0; part < boxes_.size(); ++part) {
    if (!world_from_part_[part].isZero(0)) region.AddBox(boxes_[part], world_from_part_[part]);
  }
}

void PartActor::Place(int part, const Eigen::Affine3d& world_from_part) {
  world_from_part_.at(static_cast<std::size_t>(part)) = world_from_part.matrix().cast<float>();
}

void PartActor::Hide(int part) { world_from_part_.at(static_cast<std::size_t>(part)).setZero(); }

void PartActor::Commit() {
  vtkUniforms& uniforms = shaded_.uniforms();
  uniforms.SetUniformMatrix4x4v("worldFromParts", static_cast<int>(world_from_part_.size()),
                                world_from_part_.front().data());
  uniforms.SetUniform4f("overrideColor", override_.data());
  uniforms.SetUniformf("opacityFactor", opacity_);
}

}  // namespace kinescope::render
