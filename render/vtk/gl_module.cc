#include "render/module.h"
#include "render/vtk/gl_drawing.h"

extern "C" __attribute__((visibility("default"))) const void* KinescopeDrawingModule() {
  static const kinescope::render::DrawingModule module = {{}, &kinescope::render::MakeGlDrawing};
  return &module;
}
