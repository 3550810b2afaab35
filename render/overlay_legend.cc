#include "render/overlay_legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/palette.h"

namespace kinescope::render {
namespace {

constexpr double kWidestLegend = 0.3;   // of the picture: a person is in its middle
constexpr double kHighestLegend = 0.7;  // of the picture
constexpr double kRimWidth = 0.24;      // of a sphere's radius
constexpr Ink kWhite = {{1, 1, 1}, 1};
constexpr double kPale = 0.85;  // the least of its channels: a light panel hides it

// px
struct LegendLayout {
  int font;
  double line, pad, column;  // distance of two baselines, rim of the box, width of the symbols
  double width, height;
};

// A long name has its range beside it if the picture is wide enough.
double WidthWithRanges(const LegendLayout& layout, const OverlaySizes& page,
                       const std::vector<LegendRow>& rows) {
  double width = layout.width;
  for (const LegendRow& row : rows) {
    if (row.is_addition()) continue;
    Font& font = page.fonts.regular;
    const double texts =
        font.Width(row.name, layout.font) + font.Width(row.range, layout.font) + 0.8 * layout.font;
    const double wide = 2 * layout.pad + layout.column + texts;
    if (wide <= kWidestLegend * page.width) width = std::max(width, wide);
  }
  return width;
}

LegendLayout MeasureLegend(const OverlaySizes& page, const std::vector<LegendRow>& rows,
                           std::size_t notes) {
  OverlayFonts& f = page.fonts;
  LegendLayout layout{page.FontPx(kSmallSize), page.Px(21), page.Px(12), page.Px(24), 0, 0};
  layout.width = 2 * layout.pad + layout.column +
                 std::max(f.regular.Width("centre of pressure", layout.font),
                          f.bold.Width(kLegendTitle, layout.font) - layout.column);
  layout.width = WidthWithRanges(layout, page, rows);
  const double lines =
      1.0 + static_cast<double>(rows.size()) + static_cast<double>(notes) + (notes > 0 ? 0.5 : 0.0);
  layout.height = 2 * layout.pad + layout.line * lines - page.Px(4);
  return layout;
}

bool IsWide(const LegendLayout& layout, const OverlaySizes& page) {
  return layout.width > kWidestLegend * page.width;
}

// Without the last additions, if they have no room; the last one left counts them.
std::vector<LegendRow> RowsWithRoom(const LegendContent& content, const OverlaySizes& page) {
  std::vector<LegendRow> rows = content.rows;
  std::size_t hidden = 0;
  while (!rows.empty() && rows.back().is_addition() &&
         MeasureLegend(page, rows, content.notes.size()).height > kHighestLegend * page.bottom) {
    rows.pop_back();
    ++hidden;
  }
  if (hidden > 0 && !rows.empty() && rows.back().is_addition()) {
    rows.back() = {
        {{0, 0, 0}, 0}, 0, fmt::format("+ {} more", hidden + 1), "", LegendRow::Symbol::kBox};
  }
  return rows;
}

// Of the legend's one line.
constexpr double kShortLine = 1.8;  // of its text's size

// Of the picture; the time is in the other corner.
constexpr double kWidestShortLegend = 0.6;

// For small pictures: the classes alone, in one line, so that the person is not covered. And what
// the length of arrows means, if that has room: nothing else in the picture tells it.
void PaintShortLegend(OverlayPage& page, const LegendContent& content,
                      const std::array<double, 2>& class_limits) {
  const std::string medium = fmt::format("{:.3g}", 100 * class_limits[0]);
  const std::string high = fmt::format("{:.3g}", 100 * class_limits[1]);
  const std::array<std::pair<LoadClass, std::string>, 3> classes = {{
      {LoadClass::kLow, "≤ " + medium},
      {LoadClass::kMedium, "≤ " + high},
      {LoadClass::kHigh, "> " + high + " %"},
  }};
  const int size = page.FontPx(kSmallSize);
  const double pad = 0.5 * size;
  double width = pad;
  for (const auto& [load_class, text] : classes) {
    width += 1.2 * size + page.fonts.regular.Width(text, size) + pad;
  }
  double x = page.Px(kMargin);
  const auto arrow =
      std::find_if(content.rows.begin(), content.rows.end(),
                   [](const LegendRow& row) { return row.symbol == LegendRow::Symbol::kArrow; });
  bool has_arrow = arrow != content.rows.end();
  if (has_arrow) {
    const double wider = width + 1.2 * size + page.fonts.regular.Width(arrow->range, size) + pad;
    has_arrow = x + wider <= kWidestShortLegend * page.width;
    if (has_arrow) width = wider;
  }
  const double top = page.bottom - page.Px(kMargin) - kShortLine * size;
  page.canvas.RoundedBox(x, top, width, kShortLine * size, page.Px(8), page.inks.panel);
  for (const auto& [load_class, text] : classes) {
    const double y = top + 0.9 * size;
    if (load_class == LoadClass::kHigh) {
      page.canvas.Disc(x + pad + 0.45 * size, y, 0.55 * size, page.inks.rim);
    }
    page.canvas.Disc(x + pad + 0.45 * size, y, 0.4 * size, {ColorOf(load_class), 1});
    page.canvas.Text(x + pad + 1.2 * size, top + 1.25 * size, text, page.fonts.regular, size,
                     page.inks.text);
    x += 1.2 * size + page.fonts.regular.Width(text, size) + pad;
  }
  if (!has_arrow) return;
  PaintLegendSymbol(page, *arrow, x + pad + 0.45 * size, top + 0.9 * size);
  page.canvas.Text(x + pad + 1.2 * size, top + 1.25 * size, arrow->range, page.fonts.regular, size,
                   page.inks.text);
}

void PaintDisc(OverlayPage& page, const LegendRow& row, double x, double y) {
  const double radius = page.Px(row.radius), outline = std::max(0.8, page.Px(0.8));
  const bool is_ghost = row.symbol == LegendRow::Symbol::kGhost;
  // A rim like the panel, or a translucent body, needs an edge to be seen.
  const bool is_light = page.inks.panel.color[0] > 0.5;
  const bool needs_edge = is_ghost || (row.rim == SphereRim::kWhite && is_light) ||
                          (row.rim == SphereRim::kDark && !is_light);
  if (needs_edge) page.canvas.Ring(x, y, radius, radius + outline, page.inks.faint_text);
  if (row.rim == SphereRim::kNone) return page.canvas.Disc(x, y, radius, row.ink);
  page.canvas.Disc(x, y, radius, row.rim == SphereRim::kDark ? page.inks.rim : kWhite);
  page.canvas.Disc(x, y, (1 - kRimWidth) * radius, row.ink);
}

}  // namespace

void PaintLegendSymbol(OverlayPage& page, const LegendRow& row, double x, double y) {
  switch (row.symbol) {
    case LegendRow::Symbol::kArrow: {
      const double half = page.Px(6);
      page.canvas.Polyline({{x, y + half}, {x, y - half}}, page.Px(2), row.ink);
      page.canvas.Polyline(
          {{x - 0.6 * half, y - 0.3 * half}, {x, y - half}, {x + 0.6 * half, y - 0.3 * half}},
          page.Px(2), row.ink);
      return;
    }
    case LegendRow::Symbol::kLine: {
      const double half = page.Px(row.radius);
      page.canvas.Polyline({{x - half, y}, {x + half, y}}, page.Px(3), row.ink);
      return;
    }
    case LegendRow::Symbol::kBox: {
      const double half = page.Px(row.radius), edge = half + std::max(0.8, page.Px(0.8));
      const bool is_light = page.inks.panel.color[0] > 0.5;
      const Rgb& color = row.ink.color;
      const bool is_pale = std::min({color[0], color[1], color[2]}) > kPale;
      // A hand load is as dark as the dark theme, and paper as light as the light one.
      if ((!is_light || is_pale) && row.ink.alpha > 0) {
        page.canvas.RoundedBox(x - edge, y - edge, 2 * edge, 2 * edge, page.Px(1.5),
                               page.inks.faint_text);
      }
      page.canvas.RoundedBox(x - half, y - half, 2 * half, 2 * half, page.Px(1.5), row.ink);
      return;
    }
    case LegendRow::Symbol::kDisc:
    case LegendRow::Symbol::kGhost: PaintDisc(page, row, x, y);
  }
}

LegendRoom RoomOfLegend(const OverlaySizes& sizes, const SceneLook& look,
                        const LegendContent& additions) {
  constexpr std::size_t kNotes = 2;
  LegendContent content = LegendOf({}, look);
  if (look.Shows(ScenePart::kForces)) {
    content.rows.push_back(GroundReactionRow());
  }
  if (content.rows.empty() && additions.rows.empty()) return {};
  content.notes.resize(kNotes);
  for (const LegendRow& row : additions.rows) {
    if (row.is_addition()) content.rows.push_back(row);
  }
  const LegendLayout layout = MeasureLegend(sizes, RowsWithRoom(content, sizes), kNotes);
  const double margins = 2 * sizes.Px(kMargin);
  if (!IsWide(layout, sizes)) return {layout.width + margins, layout.height + margins};
  return {sizes.width, kShortLine * sizes.FontPx(kSmallSize) + margins};
}

void PaintLegend(OverlayPage& page, const LegendContent& content,
                 const std::array<double, 2>& class_limits) {
  const std::vector<LegendRow> rows = RowsWithRoom(content, page);
  if (rows.empty()) return;
  const LegendLayout layout = MeasureLegend(page, rows, content.notes.size());
  if (IsWide(layout, page)) {
    if (content.has_classes()) PaintShortLegend(page, content, class_limits);
    return;
  }
  OverlayFonts& f = page.fonts;
  const int size = layout.font;
  const double left = page.Px(kMargin), top = page.bottom - page.Px(kMargin) - layout.height;
  const double text_left = left + layout.pad, right = left + layout.width - layout.pad;
  page.canvas.RoundedBox(left, top, layout.width, layout.height, page.Px(8), page.inks.panel);
  double baseline = top + layout.pad + 0.8 * size;
  page.canvas.Text(text_left, baseline, content.title, f.bold, size, page.inks.text);
  for (const LegendRow& row : rows) {
    baseline += layout.line;
    PaintLegendSymbol(page, row, text_left + 0.36 * layout.column, baseline - 0.36 * size);
    const double whole = right - text_left - layout.column;
    const auto has_room = [&](const std::string& name) {
      return f.regular.Width(name, size) + f.regular.Width(row.range, size) <= whole;
    };
    const bool is_short = !has_room(row.name) && !row.short_name.empty();
    const std::string& name = is_short ? row.short_name : row.name;
    // A name that needs the room of its range is the more important one.
    const bool has_range = row.is_addition() || has_room(name);
    const double range_left = has_range ? right - f.regular.Width(row.range, size) : right;
    const double room = range_left - text_left - layout.column;
    page.canvas.Text(text_left + layout.column, baseline, Shorten(name, f.regular, size, room),
                     f.regular, size, page.inks.text);
    if (has_range) {
      page.canvas.Text(range_left, baseline, row.range, f.regular, size, page.inks.text);
    }
  }
  baseline += 0.5 * layout.line;
  for (const std::string& note : content.notes) {
    baseline += layout.line;
    page.canvas.Text(text_left, baseline, note, f.regular, size, page.inks.faint_text);
  }
}

}  // namespace kinescope::render
