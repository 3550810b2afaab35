#include "render/module.h"
#include "render/plot/figure.h"

extern "C" __attribute__((visibility("default"))) const void* KinescopePlotModule() {
  static const kinescope::render::PlotModule module = {
      {}, &kinescope::render::plot::DrawSvg, &kinescope::render::plot::DrawImage};
  return &module;
}
