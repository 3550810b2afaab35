#include "render/overlay_legend_beside.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/picture_limits.h"
#include "core/system/errors.h"
#include "render/overlay_legend.h"

namespace kinescope::render {
namespace {

constexpr double kLeastScene = 0.4;  // of the picture's width or height
constexpr std::size_t kMostColumns = 8;
constexpr double kLineHeight = 1.55;  // of the text's size

// px. Rows go down the first column, then down the next one.
struct BesideLayout {
  int font;
  double line, symbol;  // distance of two baselines, width of the symbols
  std::size_t rows_per_column;
  std::vector<double> columns;            // widths
  std::vector<std::string> title, notes;  // one per line
  bool has_notes_beside_title;
  bool has_short_names;  // of rows that have one
  double width, height;  // of all of it
};

// Broken between words; a word that is wider than `width` is shortened.
std::vector<std::string> Wrapped(const std::string& text, Font& font, int size, double width) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    begin = end + 1;
    const std::string longer = lines.empty() ? word : lines.back() + " " + word;
    if (!lines.empty() && font.Width(longer, size) <= width) {
      lines.back() = longer;
    } else {
      lines.push_back(Shorten(word, font, size, width));
    }
  }
  // A unit stays with its number.
  constexpr std::size_t kShortWord = 3;
  if (lines.size() < 2 || lines.back().size() > kShortWord) return lines;
  std::string& before = lines[lines.size() - 2];
  if (const std::size_t space = before.rfind(' '); space != std::string::npos) {
    lines.back() = before.substr(space + 1) + " " + lines.back();
    before.erase(space);
  }
  return lines;
}

const std::string& NameOf(const LegendRow& row, const BesideLayout& layout) {
  return layout.has_short_names && !row.short_name.empty() ? row.short_name : row.name;
}

double WidthOf(const LegendRow& row, const BesideLayout& layout, Font& font) {
  const double range =
      row.range.empty() ? 0 : 0.9 * layout.font + font.Width(row.range, layout.font);
  return layout.symbol + font.Width(NameOf(row, layout), layout.font) + range;
}

double Gap(const BesideLayout& layout) { return 1.6 * layout.font; }

// Widths of `count` columns.
std::vector<double> Columns(const LegendContent& content, std::size_t count, BesideLayout& layout,
                            Font& font) {
  layout.rows_per_column = (content.rows.size() + count - 1) / count;
  std::vector<double> columns;
  for (std::size_t i = 0; i < content.rows.size(); ++i) {
    if (i % layout.rows_per_column == 0) columns.push_back(0);
    columns.back() = std::max(columns.back(), WidthOf(content.rows[i], layout, font));
  }
  return columns;
}

double SumOf(const BesideLayout& layout) {
  double sum = Gap(layout) * static_cast<double>(layout.columns.size() - 1);
  for (const double width : layout.columns) sum += width;
  return sum;
}

void AddTexts(const LegendContent& content, double width, bool is_strip, OverlayFonts& fonts,
              BesideLayout& layout) {
  std::string joined;
  for (const std::string& note : content.notes) joined += (joined.empty() ? "" : "; ") + note;
  const double title_width = fonts.bold.Width(content.title, layout.font);
  layout.has_notes_beside_title =
      is_strip && !joined.empty() &&
      title_width + Gap(layout) + fonts.regular.Width(joined, layout.font) <= width;
  layout.title = Wrapped(content.title, fonts.bold, layout.font, width);
  const bool fits_one_line =
      is_strip && fonts.regular.Width(joined, layout.font) <= width && !joined.empty();
  if (layout.has_notes_beside_title || fits_one_line) {
    layout.notes = {joined};
  } else {
    for (const std::string& note : content.notes) {
      for (std::string& line : Wrapped(note, fonts.regular, layout.font, width)) {
        layout.notes.push_back(std::move(line));
      }
    }
  }
  const std::size_t lines = layout.title.size() + layout.rows_per_column +
                            (layout.has_notes_beside_title ? 0 : layout.notes.size());
  layout.height = layout.line * static_cast<double>(lines);
}

// `room`: width of a strip; 0: one column.
BesideLayout LayoutOf(const OverlaySizes& sizes, const LegendContent& content, double room) {
  OverlayFonts& fonts = sizes.fonts;
  BesideLayout layout{};
  layout.font = sizes.FontPx(kSmallSize);
  layout.line = kLineHeight * layout.font;
  layout.symbol = std::max(sizes.Px(24), 1.6 * layout.font);
  const bool is_strip = room > 0;
  // As many columns as have room. Room for the scene is worth more than whole names.
  std::size_t count = is_strip ? std::min(kMostColumns, content.rows.size()) : 1;
  for (;; --count) {
    for (const bool has_short_names : {false, true}) {
      layout.has_short_names = has_short_names;
      layout.columns = Columns(content, count, layout, fonts.regular);
      layout.width = SumOf(layout);
      if (layout.width <= room || !is_strip) break;
    }
    if (layout.width <= room || count == 1) break;
  }
  AddTexts(content, is_strip ? room : layout.width, is_strip, fonts, layout);
  return layout;
}

double TopOfColumn(const OverlaySizes& sizes, const PictureSpec& spec) {
  const bool has_line = spec.parts.status || (spec.parts.title && !spec.title.empty());
  return sizes.Px(kMargin) + (has_line ? 1.8 * sizes.FontPx(kTitleSize) : 0);
}

[[noreturn]] void RefuseLegend(const PictureSpec& spec, const char* place, const char* side,
                               double needed, double given) {
  throw UsageError(fmt::format(
      "--legend={}: the legend needs {:.0f} of the picture's {:.0f} px of {}{}, and at least "
      "{:.0f} % "
      "must be left for the scene; use a larger picture{}, remove entries with --hide, or use "
      "--legend=inside",
      place, std::ceil(needed), given, side,
      spec.print.is_known() ? fmt::format(" ({} mm wide with texts of {} pt)", spec.print.width_mm,
                                          spec.print.text_pt)
                            : "",
      100 * kLeastScene, spec.print.is_known() ? " or a smaller --text_pt" : ""));
}

}  // namespace

void PlaceLegend(PictureSpec& spec, const LegendContent& content) {
  spec.scene.reset();
  spec.legend_content = nullptr;
  const bool is_beside = spec.overlays && spec.parts.legend &&
                         spec.legend != LegendPlace::kInside && !content.is_empty();
  if (!is_beside) return;
  OverlayFonts fonts;
  const OverlaySizes sizes = SizesOf(spec, fonts);
  const double margin = sizes.Px(kMargin);
  Tile scene{0, 0, spec.width, spec.height};
  if (spec.legend == LegendPlace::kBelow) {
    const double room = sizes.width - 2 * margin;
    const BesideLayout layout = LayoutOf(sizes, content, room);
    if (layout.width > room) {
      RefuseLegend(spec, "below", "width", layout.width + 2 * margin, sizes.width);
    }
    const double strip = layout.height + 0.9 * margin;
    scene.height = static_cast<int>(std::floor(sizes.bottom - strip));
    if (scene.height < std::max<double>(kMinPictureSide, kLeastScene * sizes.height)) {
      RefuseLegend(spec, "below", "height", strip, sizes.height);
    }
  } else {
    const BesideLayout layout = LayoutOf(sizes, content, 0);
    const double column = layout.width + 1.6 * margin;
    scene.width = static_cast<int>(std::floor(sizes.width - column));
    if (scene.width < std::max<double>(kMinPictureSide, kLeastScene * sizes.width)) {
      RefuseLegend(spec, "outside", "width", column, sizes.width);
    }
    const double bottom = TopOfColumn(sizes, spec) + layout.height + margin;
    if (bottom > sizes.bottom) RefuseLegend(spec, "outside", "height", bottom, sizes.height);
  }
  spec.scene = scene;
  spec.legend_content = std::make_shared<const LegendContent>(content);
}

void PaintLegendBeside(OverlayPage& page, const PictureSpec& spec) {
  const LegendContent& content = *spec.legend_content;
  const bool is_strip = spec.legend == LegendPlace::kBelow;
  const double margin = page.Px(kMargin);
  const BesideLayout layout = LayoutOf(page, content, is_strip ? page.width - 2 * margin : 0);
  const double left = is_strip ? margin : spec.scene->width + 0.6 * margin;
  const double top = is_strip ? spec.scene->height + 0.4 * margin : TopOfColumn(page, spec);
  OverlayFonts& f = page.fonts;
  const int size = layout.font;
  double baseline = top + 0.95 * size;
  double title_right = left;
  for (const std::string& line : layout.title) {
    title_right = page.canvas.Text(left, baseline, line, f.bold, size, page.inks.text);
    baseline += layout.line;
  }
  double column_left = left;
  for (std::size_t i = 0; i < content.rows.size(); ++i) {
    const std::size_t column = i / layout.rows_per_column, row = i % layout.rows_per_column;
    if (row == 0 && column > 0) column_left += layout.columns[column - 1] + Gap(layout);
    const double y = baseline + layout.line * static_cast<double>(row);
    const LegendRow& entry = content.rows[i];
    PaintLegendSymbol(page, entry, column_left + 0.4 * layout.symbol, y - 0.36 * size);
    page.canvas.Text(column_left + layout.symbol, y, NameOf(entry, layout), f.regular, size,
                     page.inks.text);
    const double range_left =
        column_left + layout.columns[column] - f.regular.Width(entry.range, size);
    page.canvas.Text(range_left, y, entry.range, f.regular, size, page.inks.text);
  }
  if (layout.has_notes_beside_title) {
    page.canvas.Text(title_right + Gap(layout), top + 0.95 * size, layout.notes.front(), f.regular,
                     size, page.inks.faint_text);
    return;
  }
  baseline += layout.line * static_cast<double>(layout.rows_per_column);
  for (const std::string& note : layout.notes) {
    page.canvas.Text(left, baseline, note, f.regular, size, page.inks.faint_text);
    baseline += layout.line;
  }
}

}  // namespace kinescope::render
