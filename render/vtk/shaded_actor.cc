#include "render/vtk/shaded_actor.h"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkOpenGLVertexBufferObject.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkShaderProperty.h>

namespace kinescope::render {
namespace {

template <class T>
vtkNew<vtkFloatArray> ToArray(const char* name, int components, const std::vector<T>& values) {
  static_assert(sizeof(T) % sizeof(float) == 0);
  vtkNew<vtkFloatArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  const auto* from = reinterpret_cast<const float*>(values.data());
  const auto count = static_cast<vtkIdType>(values.size()) * components;
  float* to = array->WritePointer(0, count);
  std::copy(from, from + count, to);
  return array;
}

}  // namespace

const char* const kLitFunction = R"(
vec3 Lit(vec3 color, vec3 normal, float sky) {
  float key = max(dot(normal, vec3(-0.439, 0.634, 0.637)), 0.0);
  float fill = max(dot(normal, vec3(0.816, 0.102, 0.569)), 0.0);
  float edge = 1.0 - max(normal.z, 0.0);
  float light = 0.47 + 0.17 * sky + 0.50 * key + 0.13 * fill;
  return color * light * (1.0 - 0.42 * edge * edge * edge);
}
)";

ShadedActor::ShadedActor(Pass pass, const ShaderText& text) {
  mapper_->ScalarVisibilityOff();
  // Otherwise large coordinates are moved and scaled behind the back of our vertex shader.
  mapper_->SetVBOShiftScaleMethod(vtkOpenGLVertexBufferObject::DISABLE_SHIFT_SCALE);
  mapper_->MapDataArrayToVertexAttribute("part", "part", vtkDataObject::FIELD_ASSOCIATION_POINTS,
                                         -1);
  mapper_->MapDataArrayToVertexAttribute("tint", "tint", vtkDataObject::FIELD_ASSOCIATION_POINTS,
                                         -1);
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
      "//VTK::Color::Dec", true,
      with("//VTK::Color::Dec", "in float part;\nin vec4 tint;\n" + text.vertex_declarations),
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

vtkUniforms& ShadedActor::uniforms() {
  return *actor_->GetShaderProperty()->GetVertexCustomUniforms();
}

void ShadedActor::SetMesh(const urdf::Mesh& mesh) {
  vtkNew<vtkPolyData> data;
  vtkNew<vtkPoints> points;
  points->SetData(ToArray("position", 3, mesh.positions));
  data->SetPoints(points);
  data->GetPointData()->SetNormals(ToArray("Normals", 3, mesh.normals));
  data->GetPointData()->AddArray(ToArray("part", 1, mesh.parts));
  data->GetPointData()->AddArray(ToArray("tint", 4, mesh.colors));
  vtkNew<vtkCellArray> cells;
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    const vtkIdType corners[] = {mesh.triangles[i], mesh.triangles[i + 1], mesh.triangles[i + 2]};
    cells->InsertNextCell(3, corners);
  }
  data->SetPolys(cells);
  mapper_->SetInputData(data);
}

}  // namespace kinescope::render
