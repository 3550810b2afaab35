#include "render/overlay_legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

namespace kinescope::render {
namespace {

constexpr double kWidestLegend = 0.3;  // of the picture: a person is in its middle
constexpr const char* kLegendTitle = "Joint load, % of capacity";

// Whether the body mass of any person is assumed: the loads are only as good as that assumption.
const PersonState* WithAssumedMass(const SceneState& state) {
  for (const PersonState& person : state.people) {
    if (!person.loads.empty() && person.model->description.mass_is_assumed) return &person;
  }
  return nullptr;
}

// What the ratios are of, and from what: of the first person who has any.
std::string MetricOf(const SceneState& state) {
  for (const PersonState& person : state.people) {
    if (person.loads.empty()) continue;
    const BodyForces& forces = person.forces;
    std::string text = Name(forces.metric);
    if (forces.metric != LoadMetric::kExternal)
      text += forces.is_dynamic ? ", dynamic" : ", static";
    return text;
  }
  return "";
}

bool HasForceOnAFoot(const SceneState& state) {
  return std::any_of(state.people.begin(), state.people.end(), [](const PersonState& person) {
    return std::any_of(
        person.forces.feet.begin(), person.forces.feet.end(),
        [](const FootForce& foot) { return foot.touches_floor && foot.force.norm() > 0; });
  });
}

// The lines below the rows, in fainter ink.
std::vector<std::string> LegendNotes(const SceneState& state) {
  std::vector<std::string> notes;
  if (std::string metric = MetricOf(state); !metric.empty()) notes.push_back(std::move(metric));
  if (const PersonState* assumed = WithAssumedMass(state)) {
    char text[64];
    std::snprintf(text, sizeof text, "body mass assumed: %.0f kg",
                  assumed->model->description.mass_kg);
    notes.emplace_back(text);
  }
  return notes;
}

// px
struct LegendLayout {
  int font;
  double line, pad, column;  // distance of two baselines, rim of the box, width of the symbols
  double width, height;
};

LegendLayout MeasureLegend(const OverlaySizes& page, std::size_t rows, std::size_t notes) {
  OverlayFonts& f = page.fonts;
  LegendLayout layout{page.FontPx(kSmallSize), page.Px(21), page.Px(12), page.Px(24), 0, 0};
  layout.width = 2 * layout.pad + layout.column +
                 std::max(f.regular.Width("centre of pressure", layout.font),
                          f.bold.Width(kLegendTitle, layout.font) - layout.column);
  const double lines =
      1.0 + static_cast<double>(rows) + static_cast<double>(notes) + (notes > 0 ? 0.5 : 0.0);
  layout.height = 2 * layout.pad + layout.line * lines - page.Px(4);
  return layout;
}

// Centred at x, y, px.
void PaintSymbol(OverlayPage& page, const LegendRow& row, double x, double y) {
  if (row.is_arrow) {
    const double half = page.Px(6);
    page.canvas.Polyline({{x, y + half}, {x, y - half}}, page.Px(2), row.ink);
    page.canvas.Polyline(
        {{x - 0.6 * half, y - 0.3 * half}, {x, y - half}, {x + 0.6 * half, y - 0.3 * half}},
        page.Px(2), row.ink);
  }
  const double radius = page.Px(row.radius);
  if (row.has_rim) page.canvas.Disc(x, y, radius, page.inks.rim);
  page.canvas.Disc(x, y, row.has_rim ? 0.76 * radius : radius, row.ink);
}

bool IsWide(const LegendLayout& layout, const OverlaySizes& page) {
  return layout.width > kWidestLegend * page.width;
}

// Of the legend's one line.
constexpr double kShortLine = 1.8;  // of its text's size

// For small pictures: the classes alone, in one line, so that the person is not covered.
void PaintShortLegend(OverlayPage& page, const SceneState& state) {
  const std::string medium = fmt::format("{:.3g}", 100 * state.class_limits[0]);
  const std::string high = fmt::format("{:.3g}", 100 * state.class_limits[1]);
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
}

}  // namespace

std::vector<LegendRow> LegendOf(const SceneState& state, const SceneLook& look) {
  std::vector<LegendRow> rows;
  const auto add = [&](ScenePart part, const Rgb& color, double radius, const char* name,
                       const std::string& range, bool has_rim = false) {
    if (look.Shows(part)) rows.push_back({{color, 1}, radius, has_rim, name, range, false});
  };
  const std::string medium = fmt::format("{:.3g} %", 100 * state.class_limits[0]);
  const std::string high = fmt::format("{:.3g} %", 100 * state.class_limits[1]);
  const auto add_class = [&](LoadClass load_class, double radius, const char* name,
                             const std::string& range, bool has_rim = false) {
    add(ScenePart::kLoads, ColorOf(load_class), radius, name, range, has_rim);
  };
  add_class(LoadClass::kLow, 6.0, "low", "≤ " + medium);
  add_class(LoadClass::kMedium, 7.2, "medium", "≤ " + high);
  add_class(LoadClass::kHigh, 8.4, "high", "> " + high, true);
  add_class(LoadClass::kUnknown, 4.8, "no data", "–");
  add(ScenePart::kCom, kComColor, 5.0, "centre of mass", "");
  add(ScenePart::kCop, kCopColor, 5.0, "centre of pressure", "");
  if (HasForceOnAFoot(state) && look.Shows(ScenePart::kForces)) {
    rows.push_back({{kCopColor, 1}, 0, false, "force on a foot", "1 m/kN", /*is_arrow=*/true});
  }
  return rows;
}

LegendRoom RoomOfLegend(const OverlaySizes& sizes, const SceneLook& look) {
  constexpr std::size_t kNotes = 2;
  const std::size_t symbols = LegendOf({}, look).size() + (look.Shows(ScenePart::kForces) ? 1 : 0);
  if (symbols == 0) return {};
  const LegendLayout layout = MeasureLegend(sizes, symbols, kNotes);
  const double margins = 2 * sizes.Px(kMargin);
  if (!IsWide(layout, sizes)) return {layout.width + margins, layout.height + margins};
  return {sizes.width, kShortLine * sizes.FontPx(kSmallSize) + margins};
}

void PaintLegend(OverlayPage& page, const SceneState& state, const SceneLook& look) {
  const std::vector<LegendRow> rows = LegendOf(state, look);
  if (rows.empty()) return;
  const std::vector<std::string> notes = LegendNotes(state);
  const LegendLayout layout = MeasureLegend(page, rows.size(), notes.size());
  if (IsWide(layout, page)) return PaintShortLegend(page, state);

  OverlayFonts& f = page.fonts;
  const int size = layout.font;
  const double left = page.Px(kMargin), top = page.bottom - page.Px(kMargin) - layout.height;
  const double text_left = left + layout.pad;
  page.canvas.RoundedBox(left, top, layout.width, layout.height, page.Px(8), page.inks.panel);
  double baseline = top + layout.pad + 0.8 * size;
  page.canvas.Text(text_left, baseline, kLegendTitle, f.bold, size, page.inks.text);
  for (const LegendRow& row : rows) {
    baseline += layout.line;
    PaintSymbol(page, row, text_left + 0.36 * layout.column, baseline - 0.36 * size);
    page.canvas.Text(text_left + layout.column, baseline, row.name, f.regular, size,
                     page.inks.text);
    const double range_left = left + layout.width - layout.pad - f.regular.Width(row.range, size);
    page.canvas.Text(range_left, baseline, row.range, f.regular, size, page.inks.text);
  }
  baseline += 0.5 * layout.line;
  for (const std::string& note : notes) {
    baseline += layout.line;
    page.canvas.Text(text_left, baseline, note, f.regular, size, page.inks.faint_text);
  }
}

}  // namespace kinescope::render
