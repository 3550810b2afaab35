/// One mesh, one draw call, our own light: what figure, spheres, marks and floor have in common.
/// The vertex shader places vertices itself (parts by matrices, spheres by centre and radius), so a
/// new pose changes a few uniforms and no buffer.
#pragma once

#include <vtkNew.h>
#include <vtkOpenGLPolyDataMapper.h>
#include <vtkUniforms.h>

#include <string>

#include "render/vtk/pass_actor.h"
#include "urdf/mesh/mesh.h"

namespace kinescope::render {

/// GLSL that is put into VTK's shaders. In `vertex`: sets gl_Position and normalVCVSOutput from
/// vertexMC, normalMC, part, tint and uniforms; in `fragment`: sets gl_FragData[0] from
/// normalVCVSOutput (unit, towards the camera) and what `vertex` hands over.
struct ShaderText {
  std::string vertex_declarations;
  std::string vertex;
  std::string fragment_declarations;
  std::string fragment;
};

class ShadedActor {
 public:
  ShadedActor(Pass pass, const ShaderText& text);
  ShadedActor(const ShadedActor&) = delete;
  ShadedActor& operator=(const ShadedActor&) = delete;

  /// Uploads `mesh`; rarely.
  void SetMesh(const urdf::Mesh& mesh);
  /// Leaves out triangles that face away: right for closed surfaces, and on at first.
  void SetCulling(bool is_on);
  /// Declared in the vertex shader by VTK; what the fragment shader uses it declares itself.
  vtkUniforms& uniforms();
  vtkActor* actor() { return actor_; }

 private:
  vtkNew<vtkOpenGLPolyDataMapper> mapper_;
  vtkNew<PassActor> actor_;
};

/// GLSL function `vec3 Lit(vec3 color, vec3 normal, float sky)`: a key light above the left
/// shoulder of who looks, a weak fill from the right, the sky, and edges that darken so that a pale
/// figure stands out from a pale background. Multiplies all channels alike: hues carry meaning
/// here.
extern const char* const kLitFunction;

}  // namespace kinescope::render
