#include "render/overlay.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "core/system/clocks.h"
#include "render/frame_code.h"
#include "render/legend.h"
#include "render/overlay_backdrop.h"
#include "render/overlay_legend.h"
#include "render/overlay_legend_beside.h"
#include "render/overlay_plot.h"
#include "render/overlay_scale.h"

namespace kinescope::render {
namespace {

constexpr Rgb kWarningLamp{0.90, 0.60, 0.05};
constexpr Rgb kMarkColor{0.25, 0.45, 0.75};

// A recording may go on without the people whose poses are old.
std::int64_t LastSampleMillis(const SceneState& state) {
  if (state.people.empty()) return state.time_code_millis;
  std::int64_t last = state.people.front().sample.time_code_millis;
  for (const PersonState& person : state.people) {
    last = std::max(last, person.sample.time_code_millis);
  }
  return last;
}

// The same page with other colours.
OverlayPage With(const OverlayPage& page, const Inks& inks) { return {page, page.canvas, inks}; }

}  // namespace

OverlayFonts& Overlay::fonts() {
  if (!fonts_) fonts_ = std::make_unique<OverlayFonts>();
  return *fonts_;
}

void Overlay::Paint(Painter& painter, const SceneState& state, const std::vector<DrawnView>& drawn,
                    const PictureSpec& spec) {
  Page page(SizesOf(spec, fonts()), painter, InksOf(spec));
  const Backdrop backdrop(spec, drawn);
  const OverlaySizes whole = page;
  for (const DrawnView& each : drawn) {
    painter.Enter(each.tile);
    page.width = each.tile.width;
    page.height = each.tile.height;
    page.bottom = std::min(page.height, whole.bottom - each.tile.y);
    const bool is_last = &each == &drawn.back();
    const SceneState& shown = each.scene != nullptr ? each.scene->state : state;
    PaintView(page, shown, each, spec, backdrop,
              is_last && spec.parts.time && !HasOnlyRobots(state));
  }
  const Tile picture{0, 0, spec.width, spec.height}, scene = spec.SceneTile();
  painter.Enter(picture);
  page.width = whole.width;
  page.height = whole.height;
  page.bottom = whole.bottom;
  PaintHead(page, state, spec, backdrop);
  if (spec.scene && spec.parts.legend) {
    Page beside = With(page, backdrop.InksBesideScene());
    painter.Begin("legend");
    PaintLegendBeside(beside, spec);
  }
  painter.Enter(scene);
  page.width = scene.width;
  page.height = scene.height;
  page.bottom = std::min(page.height, whole.bottom - scene.y);
  PaintAround(page, state, spec, backdrop);
  painter.Enter(picture);
  if (spec.parts.frame_code && state.liveness != Liveness::kNoData) {
    PaintFrameCode(painter, spec.width, spec.height, {state.counter, state.time_code_millis});
  }
}

void Overlay::PaintView(Page& page, const SceneState& state, const DrawnView& drawn,
                        const PictureSpec& spec, const Backdrop& backdrop, bool has_time_code) {
  page.canvas.Begin("names");
  PaintNames(page, state, drawn.camera, spec.parts.names, drawn.painted.labels);
  PaintMarkerTextsOf(page, drawn, backdrop);
  if (page.is_small) return;
  const double margin = page.Px(kMargin);
  if (spec.parts.scale) {
    const double time_code =
        has_time_code ? page.Px(kTimeCodeLine) + 1.3 * page.FontPx(kTitleSize) : 0;
    Page over = With(page, backdrop.InksAt(drawn.tile.x + page.right() - margin,
                                           drawn.tile.y + page.bottom - margin - time_code));
    page.canvas.Begin("scale");
    PaintScaleBar(over, drawn.camera, margin + time_code);
  }
  if (drawn.name.empty()) return;
  page.canvas.Begin("view");
  // In the upper middle, where no feet are; in the top row below title and lamp.
  const int size = page.FontPx(kSmallSize);
  const bool is_below_title = drawn.tile.y == 0 && (spec.parts.status || !spec.title.empty());
  const double top = is_below_title ? margin + 1.6 * page.FontPx(kTitleSize) : 0.5 * margin;
  const std::string name = Shorten(drawn.name, page.fonts.bold, size, page.width - 2 * margin);
  const double half = page.fonts.bold.Width(name, size) / 2;
  page.canvas.RoundedBox(page.width / 2 - half - 0.6 * size, top, 2 * half + 1.2 * size, 1.6 * size,
                         0.4 * size, page.inks.panel);
  page.canvas.Text(page.width / 2 - half, top + 1.15 * size, name, page.fonts.bold, size,
                   page.inks.text);
}

void Overlay::PaintHead(Page& page, const SceneState& state, const PictureSpec& spec,
                        const Backdrop& backdrop) {
  const double left = 2 * page.Px(kMargin), top = 1.5 * page.Px(kMargin);
  if (spec.parts.title && !page.is_small) {
    Page over = With(page, backdrop.InksAt(left, top));
    page.canvas.Begin("title");
    PaintTitle(over, state, spec);
  }
  if (spec.parts.status && !HasOnlyRobots(state)) {
    Page over = With(page, backdrop.InksAt(page.width - left, top));
    page.canvas.Begin("status");
    PaintLamp(over, state);
  }
  page.canvas.Begin("marks");
  if (spec.parts.marks && !page.is_small) PaintMarks(page, state, spec);
}

void Overlay::PaintAround(Page& page, const SceneState& state, const PictureSpec& spec,
                          const Backdrop& backdrop) {
  const OverlayParts& parts = spec.parts;
  if (parts.images && !state.images.empty()) {
    page.canvas.Begin("images");
    OverlayImages::DrawScene draw_scene;
    if (draw_scene_ != nullptr) {
      draw_scene = [&](const ImageCamera& camera, Image& pixels) {
        draw_scene_(state, camera, spec, pixels);
      };
    }
    images_.Paint(page, state, parts.plot && spec.load_curves != nullptr, draw_scene);
  }
  if (HasOnlyRobots(state)) return;
  if (!page.is_small) {
    if (parts.legend && !spec.scene) {
      page.canvas.Begin("legend");
      PaintLegend(
          page, spec.legend_content != nullptr ? *spec.legend_content : LegendOf(state, spec.look),
          state.class_limits);
    }
    if (parts.time && state.liveness != Liveness::kNoData) {
      const Tile scene = spec.SceneTile();
      const double margin = page.Px(kMargin);
      Page over = With(page, backdrop.InksAt(scene.x + page.right() - margin,
                                             scene.y + page.bottom - 1.5 * margin));
      page.canvas.Begin("time");
      PaintTimeCode(over, state);
    }
    if (parts.plot && spec.load_curves != nullptr) {
      const double below = page.Px(kMargin) + page.Px(4 * kTitleSize);
      page.canvas.Begin("plot");
      PaintPlot(page, *spec.load_curves, state.class_limits, spec.plot_secs,
                RoomOfPlot(page, 0).top, page.bottom - below);
    }
  }
  if (!parts.banner) return;
  page.canvas.Begin("banner");
  if (state.liveness == Liveness::kStale) {
    PaintBanner(page, "STALE – last sample " + TimeCode(LastSampleMillis(state)), "STALE");
  } else if (!state.left_out.empty()) {
    const LeftOutPerson& first = state.left_out.front();
    const std::string count = std::to_string(state.left_out.size());
    const std::string who = state.left_out.size() > 1 ? count + " people"
                            : first.name.empty()      ? "1 person"
                                                      : first.name;
    PaintBanner(page, "LEFT OUT – " + who + ": " + first.why, "LEFT OUT: " + count);
  }
  if (state.liveness == Liveness::kNoData) PaintNoData(page, state);
}

namespace {

struct Lamp {
  Rgb color = {0.62, 0.64, 0.67};
  std::string text = "NO DATA";
  std::string rate;
};

Lamp LampOf(const SceneState& state) {
  Lamp lamp;
  if (state.liveness == Liveness::kStale) {
    lamp.color = kWarningLamp;
    lamp.text = "STALE";
  } else if (state.liveness != Liveness::kNoData) {
    const bool is_file = state.arrival_nanos == 0;
    const bool is_behind = state.waited_nanos > kOverloadNanos;
    lamp.color = is_file ? Rgb{0.25, 0.45, 0.75} : is_behind ? kWarningLamp : Rgb{0.10, 0.70, 0.25};
    lamp.text = is_file ? "RECORDED" : is_behind ? "BEHIND" : "LIVE";
    char rate[32] = "";
    if (is_behind) {
      std::snprintf(rate, sizeof rate, "  by %.1f s", Secs(state.waited_nanos));
    } else if (state.rate_hz > 0) {
      std::snprintf(rate, sizeof rate, "  %.1f Hz", state.rate_hz);
    }
    lamp.rate = rate;
  }
  return lamp;
}

// Where its text begins.
double LeftOf(const Lamp& lamp, OverlayPage& page) {
  const int size = page.FontPx(kTextSize);
  const double width =
      page.fonts.bold.Width(lamp.text, size) + page.fonts.regular.Width(lamp.rate, size);
  return page.width - page.Px(kMargin) - width;
}

}  // namespace

void Overlay::PaintLamp(Page& page, const SceneState& state) {
  const Lamp lamp = LampOf(state);
  OverlayFonts& f = page.fonts;
  const int size = page.FontPx(kTextSize);
  if (page.is_small) {
    page.canvas.Disc(page.width - size, size, 0.36 * size, {lamp.color, 1});
    return;
  }
  const double left = LeftOf(lamp, page), baseline = page.Px(kMargin) + size;
  page.canvas.Disc(left - 0.8 * size, baseline - 0.36 * size, 0.36 * size, {lamp.color, 1});
  const double next = page.canvas.Text(left, baseline, lamp.text, f.bold, size, page.inks.text);
  page.canvas.Text(next, baseline, lamp.rate, f.regular, size, page.inks.faint_text);
}

void Overlay::PaintTitle(Page& page, const SceneState& state, const PictureSpec& spec) {
  if (spec.title.empty()) return;
  const int size = page.FontPx(kTitleSize);
  const bool is_beside_lamp = spec.parts.status && !HasOnlyRobots(state);
  const double end =
      is_beside_lamp ? LeftOf(LampOf(state), page) - 2 * page.FontPx(kTextSize) : page.right();
  const double room = end - page.Px(kMargin);
  const std::string line = Shorten(spec.title, page.fonts.bold, size, room);
  page.canvas.Text(page.Px(kMargin), page.Px(kMargin) + size, line, page.fonts.bold, size,
                   page.inks.text);
}

// Below the title; the newest last, as they came.
void Overlay::PaintMarks(Page& page, const SceneState& state, const PictureSpec& spec) {
  constexpr std::size_t kMostLines = 4;
  constexpr double kLongest = 0.42;  // of the picture's width
  Font& font = page.fonts.regular;
  const int size = page.FontPx(kTextSize);
  const double line = 1.9 * size, left = page.Px(kMargin);
  const bool has_title = spec.parts.title && !spec.title.empty();
  const bool has_lamp = spec.parts.status && !HasOnlyRobots(state);
  double top = page.Px(kMargin);
  if (has_title || has_lamp) top += 1.5 * page.FontPx(kTitleSize);
  std::vector<std::string> lines = spec.marks;
  if (lines.size() > kMostLines) {
    const std::size_t more = lines.size() - (kMostLines - 1);
    lines.erase(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(more));
    lines.insert(lines.begin(), std::to_string(more) + " more marks");
  }
  for (const std::string& each : lines) {
    const std::string text = Shorten(each, font, size, kLongest * page.width);
    const double width = font.Width(text, size) + 1.9 * size;
    page.canvas.RoundedBox(left, top, width, 1.6 * size, 0.4 * size, page.inks.panel);
    page.canvas.RoundedBox(left + 0.4 * size, top + 0.35 * size, 0.3 * size, 0.9 * size,
                           0.15 * size, {kMarkColor, 1});
    page.canvas.Text(left + 1.1 * size, top + 1.14 * size, text, font, size, page.inks.text);
    top += line;
  }
}

void Overlay::PaintTimeCode(Page& page, const SceneState& state) {
  OverlayFonts& f = page.fonts;
  const int size = page.FontPx(kTitleSize), small = page.FontPx(kSmallSize);
  const std::string time = TimeCode(state.time_code_millis);
  const std::string sample = "sample " + std::to_string(state.counter);
  const double right = page.width - page.Px(kMargin), bottom = page.bottom - page.Px(kMargin);
  const double left = right - f.regular.Width(time, size);
  page.canvas.Text(left, bottom - page.Px(kTimeCodeLine), time, f.regular, size, page.inks.text);
  if (state.liveness == Liveness::kNoPerson) return;  // there is no sample
  page.canvas.Text(right - f.regular.Width(sample, small), bottom, sample, f.regular, small,
                   page.inks.faint_text);
}

// `brief`: where `full` has no room.
void Overlay::PaintBanner(Page& page, const std::string& full, const std::string& brief) {
  OverlayFonts& f = page.fonts;
  const int size = page.FontPx(18);
  const double room = page.width - 4 * size;
  const std::string text = f.bold.Width(full, size) <= room ? full : brief;
  const double width = f.bold.Width(text, size) + 2 * size;
  const double left = (page.width - width) / 2, top = page.Px(kMargin + 28);
  page.canvas.RoundedBox(left, top, width, 2 * size, 0.5 * size, page.inks.banner);
  page.canvas.Text(left + size, top + 1.36 * size, text, f.bold, size, page.inks.on_banner);
}

void Overlay::PaintNoData(Page& page, const SceneState& state) {
  OverlayFonts& f = page.fonts;
  const int size = page.FontPx(44), small = page.FontPx(18);
  const std::string title = "NO DATA";
  const std::string source = state.source.empty() ? "a source" : state.source;
  const std::string detail =
      Shorten("waiting for " + source, f.regular, small, page.width - 4 * small);
  const double width =
      std::max(f.bold.Width(title, size), f.regular.Width(detail, small)) + 2.4 * size;
  const double height = 2.1 * size + 1.4 * small;
  const double left = (page.width - width) / 2, top = (page.height - height) / 2;
  page.canvas.RoundedBox(left, top, width, height, 0.3 * size, page.inks.notice);
  page.canvas.Text((page.width - f.bold.Width(title, size)) / 2, top + 1.4 * size, title, f.bold,
                   size, page.inks.faint_text);
  page.canvas.Text((page.width - f.regular.Width(detail, small)) / 2,
                   top + 1.55 * size + 1.3 * small, detail, f.regular, small, page.inks.faint_text);
}

void Overlay::PaintNames(Page& page, const SceneState& state, const Camera& camera, bool has_names,
                         const std::vector<Label>& labels) {
  const auto project = [&](const Eigen::Vector3d& position) {
    return Project(position, camera, static_cast<int>(page.width), static_cast<int>(page.height));
  };
  OverlayFonts& f = page.fonts;
  const int size = page.FontPx(kSmallSize);
  struct Name {
    std::string text;
    bool is_faint;
    double x, y;
  };
  std::vector<Name> names;
  std::vector<LabelBox> boxes;
  const auto add = [&](const Eigen::Vector3d& position, const std::string& name, bool is_faint) {
    const Projected at = project(position);
    if (!(at.depth_m > 0) || name.empty()) return;
    const std::string text = Shorten(name, f.regular, size, page.Px(220));
    names.push_back({text, is_faint, at.x_px, at.y_px});
    boxes.push_back({at.x_px, at.y_px - 0.15 * size, f.regular.Width(text, size) + 1.2 * size,
                     1.7 * size, !is_faint});
  };
  for (const Label& label : labels) {
    const bool is_shown =
        label.kind == Label::Kind::kFault || (label.kind == Label::Kind::kName && has_names);
    if (is_shown) add(label.position, label.text, false);
  }
  for (const PersonState& person : state.people) {
    if (!has_names || state.people.size() < 2) break;
    const urdf::Pose& head = person.links[urdf::kHead];
    const Eigen::Vector3d top =
        head.position + head.orientation * person.model->human.skeleton.head_top_in_head;
    const std::string name =
        person.name.empty() ? "person " + std::to_string(person.character + 1) : person.name;
    add(top + Eigen::Vector3d(0, 0, 0.12), name, false);
  }
  for (const Label& label : labels) {
    if (label.kind == Label::Kind::kFloor) add(label.position, label.text, true);
  }
  const auto places = PlaceLabels(boxes, page.width, page.height);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!places[i]) continue;
    const double left = places[i]->left, top = places[i]->top;
    if (places[i]->is_moved) PaintLeader(page, names[i].x, names[i].y, boxes[i], *places[i]);
    if (!names[i].is_faint) {
      page.canvas.RoundedBox(left, top, boxes[i].width, boxes[i].height, 0.5 * size,
                             page.inks.panel);
    }
    page.canvas.Text(left + 0.6 * size, top + 1.25 * size, names[i].text, f.regular, size,
                     names[i].is_faint ? page.inks.faint_text : page.inks.text);
  }
}

// From what a label is about to its box.
void Overlay::PaintLeader(Page& page, double x, double y, const LabelBox& box,
                          const LabelPlace& place) {
  const double end_x = std::clamp(x, place.left, place.left + box.width);
  const double end_y = std::clamp(y, place.top, place.top + box.height);
  const double width = std::max(1.2, page.Px(1.4));
  page.canvas.Disc(x, y, 1.5 * width, page.inks.faint_text);
  page.canvas.Polyline({{x, y}, {end_x, end_y}}, width, page.inks.faint_text);
}

void Overlay::PaintMarkerTextsOf(Page& page, const DrawnView& drawn, const Backdrop& backdrop) {
  for (const Label& label : drawn.painted.labels) {
    if (label.kind != Label::Kind::kMarker) continue;
    const Projected at = Project(label.position, drawn.camera, static_cast<int>(page.width),
                                 static_cast<int>(page.height));
    const bool is_there = at.depth_m > 0 && std::abs(at.x_px) < 1e5 && std::abs(at.y_px) < 1e5;
    if (!is_there) continue;
    PaintMarkerText(page, label, at,
                    backdrop.ColorAt(drawn.tile.x + at.x_px, drawn.tile.y + at.y_px));
  }
}

void Overlay::PaintMarkerTexts(Painter& painter, const std::vector<DrawnView>& drawn,
                               const PictureSpec& spec) {
  Page page(SizesOf(spec, fonts()), painter, InksOf(spec));
  const Backdrop backdrop(spec, drawn);
  painter.Begin("names");
  for (const DrawnView& each : drawn) {
    painter.Enter(each.tile);
    page.width = each.tile.width;
    page.height = each.tile.height;
    PaintMarkerTextsOf(page, each, backdrop);
  }
}

// Line by line, as high as it is in the world. In steps, so that a text that comes nearer does not
// fill the font's memory with every size there is. Markers of RViz are often white, as the names of
// frames: on a light background they have a dark panel. The page has the same (surroundings.js).
void Overlay::PaintMarkerText(Page& page, const Label& label, const Projected& at,
                              const Rgb& behind) {
  constexpr double kCapitalShare = 0.73;  // of a size, DejaVu Sans
  constexpr double kSmallest = 5, kLargest = 384, kLine = 1.2;
  const double wanted = label.height_m * at.px_per_m / kCapitalShare;
  if (!(wanted >= kSmallest)) return;
  const double step = wanted < 24 ? 1 : wanted < 96 ? 4 : 32;
  const int size = static_cast<int>(step * std::round(std::min(wanted, kLargest) / step));
  Font& font = page.fonts.regular;
  const auto breaks = std::count(label.text.begin(), label.text.end(), '\n');
  double y = at.y_px + 0.5 * (kCapitalShare - kLine * static_cast<double>(breaks)) * size;
  std::vector<std::string> texts;
  double width = 0;
  std::istringstream lines(label.text);
  for (std::string line; std::getline(lines, line);) {
    texts.push_back(Shorten(line, font, size, page.width));
    width = std::max(width, font.Width(texts.back(), size));
  }
  constexpr double kLeastContrast = 0.3;
  const double lightness = Lightness(behind);
  if (std::abs(Lightness(label.color) - lightness) < kLeastContrast) {
    Ink panel = (lightness > 0.5 ? kDarkInks : kLightInks).panel;
    panel.alpha *= label.opacity;
    page.canvas.RoundedBox(at.x_px - width / 2 - 0.4 * size, y - 1.1 * size, width + 0.8 * size,
                           kLine * size * static_cast<double>(texts.size()) + 0.3 * size,
                           0.3 * size, panel);
  }
  for (const std::string& text : texts) {  // with one left edge, as in RViz
    page.canvas.Text(at.x_px - width / 2, y, text, font, size, {label.color, label.opacity});
    y += kLine * size;
  }
}

std::string TimeCode(std::int64_t millis) {
  char text[48];
  const auto bits = static_cast<unsigned long long>(millis);
  const unsigned long long total = millis < 0 ? 0 - bits : bits;
  std::snprintf(text, sizeof text, "%s%02llu:%02llu:%02llu.%03llu", millis < 0 ? "-" : "",
                total / 3600000, total / 60000 % 60, total / 1000 % 60, total % 1000);
  return text;
}

}  // namespace kinescope::render
