/// Renders one mesh in one draw call with Kinescope's own lighting: the base of body, spheres,
/// marks and floor. The vertex shader places the vertices itself (parts by matrices, spheres by
/// centre and radius), so a new pose changes a few uniforms and no buffer.
#pragma once

#include <vtkNew.h>
#include <vtkOpenGLPolyDataMapper.h>
#include <vtkPolyData.h>
#include <vtkUniforms.h>

#include <cstdint>
#include <string>
#include <vector>

#include "core/palette.h"
#include "render/vtk/pass_actor.h"
#include "urdf/mesh/mesh.h"

class vtkFloatArray;

namespace kinescope::render {

/// GLSL that is inserted into VTK's shaders. `vertex` sets gl_Position and normalVCVSOutput from
/// vertexMC, normalMC, the attributes and uniforms. `fragment` sets gl_FragData[0] from
/// normalVCVSOutput (unit, towards the camera) and the outputs of `vertex`.
struct ShaderText {
  std::string vertex_declarations;
  std::string vertex;
  std::string fragment_declarations;
  std::string fragment;
};

/// A property of the vertices: floats, by its name in the shader and in the point data.
struct VertexAttribute {
  std::string name;
  int components = 1;  // 1 to 4
};

/// Keeps the indices of a surface whose vertices have moved. VTK 9.1 makes and uploads them again.
class SurfaceMapper : public vtkOpenGLPolyDataMapper {
 public:
  static SurfaceMapper* New();

 protected:
  void BuildIBO(vtkRenderer* renderer, vtkActor* actor, vtkPolyData* data) override;
};

class ShadedActor {
 public:
  /// Of a urdf::Mesh: `float part` and `vec4 tint`.
  static std::vector<VertexAttribute> AttributesOfMesh();

  /// For SetMesh().
  ShadedActor(Pass pass, const ShaderText& text);
  /// For SetSurface().
  ShadedActor(Pass pass, const ShaderText& text, const std::vector<VertexAttribute>& attributes);
  ShadedActor(const ShadedActor&) = delete;
  ShadedActor& operator=(const ShadedActor&) = delete;

  /// Uploads `mesh`; expensive, so call it rarely.
  void SetMesh(const urdf::Mesh& mesh);
  /// Triangles (three vertices each) with normals and the attributes, which have names. Arrays that
  /// are `Modified()` are uploaded again.
  void SetSurface(vtkFloatArray* positions, vtkFloatArray* normals,
                  const std::vector<vtkFloatArray*>& attributes,
                  const std::vector<std::uint32_t>& triangles);
  /// Other triangles between the vertices of SetSurface().
  void SetTriangles(const std::vector<std::uint32_t>& triangles);
  /// Skips triangles that face away: correct for closed surfaces. Initially on.
  void SetCulling(bool is_on);
  /// VTK declares them in the vertex shader; the fragment shader declares those that it uses
  /// itself.
  vtkUniforms& uniforms();
  /// A uniform vec3.
  void SetColor(const char* name, const Rgb& rgb);
  vtkActor* actor() { return actor_; }
  bool is_visible() const;

 private:
  vtkNew<vtkPolyData> data_;
  vtkNew<SurfaceMapper> mapper_;
  vtkNew<PassActor> actor_;
};

/// GLSL function `vec3 Lit(vec3 color, vec3 normal, float sky)`: a key light above the viewer's
/// left shoulder, a weak fill light from the right, the sky, and darker edges that separate a pale
/// body from a pale background. It scales all channels equally, because hues carry meaning.
extern const char* const kLitFunction;

}  // namespace kinescope::render
