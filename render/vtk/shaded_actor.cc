#include "render/vtk/shaded_actor.h"

#include <vtkCellArray.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLVertexBufferObject.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkProperty.h>
#include <vtkShaderProperty.h>

#include "render/vtk/float_array.h"

namespace kinescope::render {
const char* const kLitFunction = R"(
vec3 Lit(vec3 color, vec3 normal, float sky) {
  float key = max(dot(normal, vec3(-0.439, 0.634, 0.637)), 0.0);
  float fill = max(dot(normal, vec3(0.816, 0.102, 0.569)), 0.0);
  float edge = 1.0 - max(normal.z, 0.0);
  float light = 0.47 + 0.17 * sky + 0.50 * key + 0.13 * fill;
  return color * light * (1.0 - 0.42 * edge * edge * edge);
}
)";

vtkStandardNewMacro(SurfaceMapper)

    void SurfaceMapper::BuildIBO(vtkRenderer* renderer, vtkActor* actor, vtkPolyData* data) {
  TempState.Clear();  // of what the vertices depend on
  vtkOpenGLPolyDataMapper::BuildIBO(renderer, actor, data);
}

std::vector<VertexAttribute> ShadedActor::AttributesOfMesh() { return {{"part", 1}, {"tint", 4}}; }

ShadedActor::ShadedActor(Pass pass, const ShaderText& text)
    : ShadedActor(pass, text, AttributesOfMesh()) {}

ShadedActor::ShadedActor(Pass pass, const ShaderText& text,
                         const std::vector<VertexAttribute>& attributes) {
  mapper_->ScalarVisibilityOff();
  // Otherwise large coordinates are moved and scaled behind the back of our vertex shader.
  mapper_->SetVBOShiftScaleMethod(vtkOpenGLVertexBufferObject::DISABLE_SHIFT_SCALE);
  std::string declarations;
  for (const VertexAttribute& attribute : attributes) {
    const char* const name = attribute.name.c_str();
    mapper_->MapDataArrayToVertexAttribute(name, name, vtkDataObject::FIELD_ASSOCIATION_POINTS, -1);
    const std::string type =
        attribute.components == 1 ? "float" : "vec" + std::to_string(attribute.components);
    declarations += "in " + type + " " + attribute.name + ";\n";
  }
  actor_->SetMapper(mapper_);
  actor_->SetPass(pass);
  actor_->ForceOpaqueOn();
  actor_->UseBoundsOff();
  actor_->PickableOff();
  actor_->GetProperty()->BackfaceCullingOn();

  vtkShaderProperty* shader = actor_->GetShaderProperty();
  const auto with = [](const char* token, const std::string& more) {
    return std::string(token) + "\n" + more;
  };
  shader->AddVertexShaderReplacement(
      "//VTK::Color::Dec", true, with("//VTK::Color::Dec", declarations + text.vertex_declarations),
      false);
  shader->AddVertexShaderReplacement("//VTK::CustomEnd::Impl", true,
                                     with("//VTK::CustomEnd::Impl", text.vertex), false);
  shader->AddFragmentShaderReplacement(
      "//VTK::Color::Dec", true,
      with("//VTK::Color::Dec", text.fragment_declarations + kLitFunction), false);
  // VTK's shader goes on to discard what is fully transparent, and a shader that may discard must
  // run before its depth test. Returning first lets hidden pixels be skipped unshaded.
  shader->AddFragmentShaderReplacement("//VTK::Light::Impl", true, text.fragment + "  return;\n",
                                       false);
}

void ShadedActor::SetCulling(bool is_on) { actor_->GetProperty()->SetBackfaceCulling(is_on); }

bool ShadedActor::is_visible() const { return actor_->GetVisibility() != 0; }

vtkUniforms& ShadedActor::uniforms() {
  return *actor_->GetShaderProperty()->GetVertexCustomUniforms();
}

void ShadedActor::SetColor(const char* name, const Rgb& rgb) {
  const float color[3] = {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]),
                          static_cast<float>(rgb[2])};
  uniforms().SetUniform3f(name, color);
}

void ShadedActor::SetMesh(const urdf::Mesh& mesh) {
  const auto positions = ToFloatArray("position", 3, mesh.positions);
  const auto normals = ToFloatArray("Normals", 3, mesh.normals);
  const auto parts = ToFloatArray("part", 1, mesh.parts);
  const auto tints = ToFloatArray("tint", 4, mesh.colors);
  SetSurface(positions, normals, {parts, tints}, mesh.triangles);
}

void ShadedActor::SetSurface(vtkFloatArray* positions, vtkFloatArray* normals,
                             const std::vector<vtkFloatArray*>& attributes,
                             const std::vector<std::uint32_t>& triangles) {
  data_->Initialize();
  vtkNew<vtkPoints> points;
  points->SetData(positions);
  data_->SetPoints(points);
  data_->GetPointData()->SetNormals(normals);
  for (vtkFloatArray* attribute : attributes) data_->GetPointData()->AddArray(attribute);
  SetTriangles(triangles);
  mapper_->SetInputData(data_);
}

void ShadedActor::SetTriangles(const std::vector<std::uint32_t>& triangles) {
  vtkNew<vtkCellArray> cells;
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const vtkIdType corners[] = {triangles[i], triangles[i + 1], triangles[i + 2]};
    cells->InsertNextCell(3, corners);
  }
  data_->SetPolys(cells);
}

}  // namespace kinescope::render
