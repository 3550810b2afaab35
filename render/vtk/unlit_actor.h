/// Draws what faces the camera and has colours of its own, in one draw call: these are not lit, so
/// that they mean what a legend or another program says they mean. What it measures in pixels are
/// those of the picture.
#pragma once

#include <string>
#include <vector>

#include "render/vtk/shaded_actor.h"

namespace kinescope::render {

class UnlitActor {
 public:
  /// The size of what is drawn into the whole viewport, a picture or a tile of it: pixels of the
  /// picture, which are larger than those drawn if it is supersampled. Call it before each drawing.
  void SetViewSize(int width_px, int height_px);
  vtkActor* actor() { return shaded_.actor(); }
  /// By part of the actor: the markers, "scan/0".
  const std::vector<std::string>& names() const { return names_; }

 protected:
  /// `place` sets gl_Position; `uniform vec2 clipPerPixel` is what a pixel is there.
  UnlitActor(bool is_blended, const std::string& place,
             const std::vector<VertexAttribute>& attributes);
  ~UnlitActor() = default;

  /// Begins with none, and is not seen.
  void Clear();
  /// The next part.
  int AddPart(const std::string& name);
  /// Two triangles between the last four corners of `corners`, which are in order around it.
  static void CloseSquare(urdf::Mesh& corners);

  const bool is_blended_;  // draws those that are, or the others
  ShadedActor shaded_;

 private:
  std::vector<std::string> names_;
};

}  // namespace kinescope::render
