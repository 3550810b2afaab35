#include "render/plot.h"

#include "core/system/check.h"
#include "render/module.h"

namespace kinescope::render {
namespace {

const PlotModule& OpenPlotModule() {
  static const PlotModule& module = OpenModule<PlotModule>("libkinescope_plot.so", kPlotEntry);
  return module;
}

}  // namespace

std::string ToSvg(const Plot& plot) { return OpenPlotModule().svg(plot); }

Image ToImage(const Plot& plot, double px_per_pt) {
  KINESCOPE_CHECK(px_per_pt >= 0.5 && px_per_pt <= 20);
  return OpenPlotModule().image(plot, px_per_pt);
}

std::unique_ptr<LayerPainter> MakeLayerPainter(int width_px, int height_px, double width_mm,
                                               LayerFormat format, const Image* below) {
  return OpenPlotModule().layer(width_px, height_px, width_mm, format, below);
}

}  // namespace kinescope::render
