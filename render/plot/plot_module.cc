#include "render/module.h"
#include "render/plot/layer.h"
#include "render/plot/plot_drawing.h"

extern "C" __attribute__((visibility("default"))) const void* KinescopePlotModule() {
  static const kinescope::render::PlotModule module = {{},
                                                       &kinescope::render::plot::DrawSvg,
                                                       &kinescope::render::plot::DrawImage,
                                                       &kinescope::render::plot::MakeLayer};
  return &module;
}
