/// Draws plots for papers and reports: curves over an axis with bands, limits and gaps, as SVG
/// and as a picture of the same description. Cairo draws them in a module that is loaded with the
/// first plot. Lengths in points (1/72 inch), y downwards. Any thread; a plot is used by one at
/// a time.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/palette.h"
#include "render/image/image.h"

namespace kinescope::render {

struct PlotCurve {
  std::string name;  // in the legend; "": none
  Rgb color = {0.1, 0.1, 0.1};
  std::vector<double> dash;  // pt, on and off; empty: solid
  double width = 1.1;        // pt
  /// x ascending; y NaN: the line is interrupted. There is no limit: points that cannot be
  /// distinguished are thinned out, peaks are kept.
  std::vector<std::pair<double, double>> points;
};

/// A range of y with a background colour.
struct PlotBand {
  double from = 0, to = 0;
  Rgb color = {1, 1, 1};
  std::string label;  // at its right; "": none
};

struct PlotLimit {
  double y = 0;
  std::string label;  // at its right end; "": none
};

/// A range of x without known values: hatched.
struct PlotGap {
  double from = 0, to = 0;
};

/// A range of x in the class timeline below the curves. Colour and height show the class.
struct PlotClassInterval {
  double from = 0, to = 0;
  LoadClass load_class = LoadClass::kUnknown;
};

struct PlotMark {
  double x = 0, y = 0;
  std::string label;
};

/// Of moments and spans that a person marked, in plots and reports.
inline constexpr Rgb kFlagInk = {0.15, 0.33, 0.62};

/// A moment or a span of x: a line at each end, and a label above the first.
struct PlotFlag {
  double from = 0, to = 0;
  std::string label;  // "": none
};

/// One pair of axes with its content.
struct PlotPanel {
  double left = 0, top = 0, width = 0, height = 0;  // of the axes' box, within the plot
  std::string title, x_label, y_label;
  bool has_x_numbers = true, has_y_numbers = true;
  double x_from = 0, x_to = 1, y_from = 0, y_to = 1;  // @pre from < to, finite
  std::vector<PlotBand> bands;
  std::vector<PlotGap> gaps;
  std::vector<PlotLimit> limits;
  std::vector<PlotCurve> curves;
  std::vector<PlotClassInterval> class_timeline;
  std::vector<PlotMark> marks;
  std::vector<PlotFlag> flags;
  double font_size = 8;
};

struct PlotText {
  double x = 0, y = 0;  // start of the text on the baseline
  std::string text;
  double size = 8;
  bool is_bold = false;
  Rgb color = {0.13, 0.15, 0.19};
};

/// A sample of a colour or of the hatching, for legends.
struct PlotSwatch {
  double x = 0, y = 0, width = 0, height = 0;
  Rgb color;
  bool is_hatched = false;
};

struct Plot {
  double width = 480, height = 300;
  std::vector<PlotPanel> panels;
  std::vector<PlotSwatch> swatches;
  std::vector<PlotText> texts;
};

// The following two functions @throw RenderError if the module or its font is missing.

/// Text is converted to outlines, so it looks the same whatever fonts are installed.
std::string ToSvg(const Plot& plot);
/// @pre 0.5 <= px_per_pt <= 20
Image ToImage(const Plot& plot, double px_per_pt);

/// Round numbers that divide [from, to] into about `most` parts. @pre from < to
std::vector<double> NiceTicks(double from, double to, int most);

/// `points` (x ascending) reduced to the number that `columns` pixels of [from, to] can show:
/// first, lowest, highest and last of each column. Interruptions (NaN) stay.
std::vector<std::pair<double, double>> Thinned(const std::vector<std::pair<double, double>>& points,
                                               double from, double to, int columns);

}  // namespace kinescope::render
