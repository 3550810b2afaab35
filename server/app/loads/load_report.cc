#include "server/app/loads/load_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "core/palette.h"
#include "core/system/check.h"
#include "core/system/stop_signal.h"
#include "render/camera/camera.h"
#include "render/image/new_file.h"
#include "render/image/png_file.h"
#include "render/plot.h"
#include "render/renderer.h"
#include "server/app/loads/html.h"
#include "server/app/loads/load_plots.h"
#include "server/app/loads/load_rows.h"
#include "server/loads/joint_score.h"

namespace kinescope::app {
namespace {

constexpr std::size_t kPictures = 3;

std::string CssColor(LoadClass load_class) {
  const Rgb color = ColorOf(load_class);
  return fmt::format("rgb({:.0f},{:.0f},{:.0f})", 255 * color[0], 255 * color[1], 255 * color[2]);
}

// Sizes are those of the printed page; the screen shows the page.
std::string Style() {
  return fmt::format(
      R"(@page {{ size: A4; margin: 8mm 12mm; }}
* {{ box-sizing: border-box; }}
body {{ margin: 0; background: #e9ebee; color: #21262f; font: 7.2pt/1.3 "DejaVu Sans", Arial, sans-serif;
  -webkit-print-color-adjust: exact; print-color-adjust: exact; }}
main {{ width: 210mm; margin: 6mm auto; padding: 10mm 12mm; background: #fff; box-shadow: 0 1px 6px #0003; }}
h1 {{ font-size: 13pt; margin: 0; overflow-wrap: anywhere; }}
h2 {{ font-size: 8.5pt; margin: 2mm 0 .8mm; }}
p {{ margin: 0 0 .6mm; }}
.sub {{ color: #61666f; }}
dl {{ display: flex; flex-wrap: wrap; gap: .6mm 5mm; margin: 1.5mm 0 0; }}
dl div {{ display: flex; gap: 1.2mm; }}
dt {{ color: #61666f; }} dd {{ margin: 0; font-weight: bold; }}
.assumed {{ color: #9a4a00; font-weight: normal; }}
.moments {{ display: grid; grid-template-columns: repeat({0}, 1fr); gap: 4mm; }}
figure {{ margin: 0; }} figcaption {{ line-height: 1.3; }}
figure img {{ width: 100%; display: block; border: .2mm solid #d3d6da; }}
table {{ width: 100%; border-collapse: collapse; font-variant-numeric: tabular-nums; line-height: 1.2; }}
th {{ text-align: right; font-weight: normal; color: #61666f; border-bottom: .3mm solid #21262f; padding: 0 0 .5mm 1.5mm; white-space: nowrap; }}
td {{ text-align: right; padding: .3mm 0 .3mm 1.5mm; white-space: nowrap; border-bottom: .1mm solid #e2e4e7; }}
th:first-child, td:first-child, .text {{ text-align: left; padding-left: 0; }}
td.text, th.text {{ padding-left: 2mm; }}
.bar {{ display: flex; width: 14mm; height: 2.6mm; }}
.low {{ background: {1}; }} .medium {{ background: {2}; }} .high {{ background: {3}; }}
.unknown {{ background: repeating-linear-gradient(135deg, #a9adb5 0 .25mm, #eceef0 .25mm 1.1mm); }}
.key {{ display: inline-block; width: 3mm; height: 2.2mm; margin: 0 1mm 0 2mm; }}
.plot {{ width: 100%; display: block; }}
ul {{ margin: 0; padding-left: 3.5mm; }}
footer {{ color: #61666f; margin-top: 2mm; border-top: .1mm solid #d3d6da; padding-top: .8mm; overflow-wrap: anywhere; }}
@media print {{
  body {{ background: #fff; }}
  main {{ width: auto; margin: 0; padding: 0; box-shadow: none; break-after: page; }}
  main:last-child {{ break-after: auto; }}
}})",
      kPictures, CssColor(LoadClass::kLow), CssColor(LoadClass::kMedium),
      CssColor(LoadClass::kHigh));
}

std::string Number(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "–";
}

std::string HeadHtml(const LoadTrial& trial, const TrialContext& context) {
  std::string html = fmt::format(
      "<h1>Joint loads: {}</h1>\n<p class=\"sub\">{}, {} samples, {:.2f} s{}{}</p>\n<dl>",
      EscapeHtml(context.source), EscapeHtml(TitleOf(trial)), trial.samples(), trial.secs(),
      context.rate_hz > 0 ? fmt::format(" at {:g} Hz", context.rate_hz) : "",
      trial.newest().sample.has_time_of_day
          ? ", starting at " + IsoTime(trial.curves().front().stamp_nanos)
          : "");
  for (const Fact& fact : FactsOf(trial, context)) {
    html += fmt::format("<div><dt>{}</dt><dd>{}{}</dd></div>\n", EscapeHtml(fact.label),
                        EscapeHtml(fact.value),
                        fact.is_assumed ? " <span class=\"assumed\">assumed</span>" : "");
  }
  return html + "</dl>\n";
}

const PersonState& PersonIn(const SceneState& scene, int character) {
  const auto found =
      std::find_if(scene.people.begin(), scene.people.end(),
                   [&](const PersonState& person) { return person.character == character; });
  KINESCOPE_CHECK(found != scene.people.end());
  return *found;
}

std::string CaptionHtml(const LoadTrial& trial, const WorstMoment& moment,
                        const PersonState& person) {
  const JointLoad& load = person.loads[moment.joint];
  const std::string head = fmt::format(
      "<b>{:.2f} s</b> {}: ", trial.SecsOf(person.sample.stamp_nanos), ScoredLabel(moment.joint));
  if (load.is_of_compression) {
    return head + fmt::format("{:.0f} N compression ({})", person.forces.lumbar->compression,
                              Name(load.band));
  }
  const std::string of =
      std::isfinite(load.capacity)
          ? fmt::format(", {:.0f} of {:.0f} N·m", std::abs(load.deciding_moment), load.capacity)
          : "";
  return head + fmt::format("{:.2f} ({}), {}{}", load.ratio, Name(load.band),
                            EscapeHtml(load.channel), of);
}

// The named camera, drawn near: `person` fills the picture.
render::Camera CloseUp(const SceneState& scene, const PersonState& person,
                       const render::PictureSpec& view) {
  Eigen::AlignedBox3d box;
  for (const urdf::Pose& link : person.links) box.extend(link.position);
  render::Camera camera = render::NamedCamera("three_quarter", scene);
  camera.position += box.center() - camera.target;
  camera.target = box.center();
  const double widest = camera.vertical_fov_rad;
  const auto fits = [&] {
    constexpr double kAround = 0.22;  // m, from the joints to skin, top of the head, finger tips
    return std::all_of(person.links.begin(), person.links.end(), [&](const urdf::Pose& link) {
      const render::Projected at = render::Project(link.position, camera, view.width, view.height);
      const double around = kAround * at.px_per_m;
      return at.x_px >= around && at.x_px <= view.width - around && at.y_px >= around &&
             at.y_px <= view.height - around;
    });
  };
  for (int percent = 40; percent < 100; percent += 2) {
    camera.vertical_fov_rad = 0.01 * percent * widest;
    if (fits()) break;
  }
  return camera;
}

std::string MomentsHtml(const LoadTrial& trial, render::Renderer& renderer) {
  const render::PictureSpec view = {560, 410, 2, {}, false};
  const std::vector<WorstMoment> worst = trial.Worst(kPictures);
  if (worst.empty()) return "<p>No load could be computed at any time.</p>\n";
  std::string html = "<div class=\"moments\">\n";
  for (const WorstMoment& moment : worst) {
    if (StopRequested()) throw std::runtime_error("interrupted; the report was not written");
    const PersonState& person = PersonIn(*moment.scene, trial.newest().character);
    const render::Image image =
        renderer.Render(*moment.scene, CloseUp(*moment.scene, person, view), view);
    const std::vector<std::uint8_t> png = render::EncodePng(image);
    const std::string caption = CaptionHtml(trial, moment, person);
    html += fmt::format(
        "<figure><img alt=\"\" src=\"{}\"><figcaption>{}</figcaption></figure>\n",
        DataUrl("image/png", {reinterpret_cast<const char*>(png.data()), png.size()}), caption);
  }
  return html + "</div>\n";
}

double PercentIn(LoadClass band, const loads::JointExposure& exposure, std::uint64_t all) {
  const auto samples = static_cast<double>(exposure.samples[static_cast<std::size_t>(band)]);
  return 100 * samples / static_cast<double>(all);
}

std::string BarHtml(const loads::JointExposure& exposure, std::uint64_t all) {
  std::string bar = "<div class=\"bar\">";
  for (const LoadClass band : kLoadClassesOfTables) {
    const double percent = PercentIn(band, exposure, all);
    if (percent <= 0) continue;
    bar += fmt::format("<i class=\"{}\" style=\"width:{:.2f}%\"></i>", Name(band), percent);
  }
  return bar + "</div>";
}

std::string ExposureHtml(const LoadTrial& trial) {
  std::string html = "<table>\n<tr><th>joint</th><th class=\"text\">share</th>";
  for (const LoadClass load_class : kLoadClassesOfTables) {
    html += fmt::format("<th>{} %</th>", Name(load_class));
  }
  html +=
      "<th>P10</th><th>P50</th><th>P90</th><th>peak</th><th>at (s)</th><th>longest (s)</th>"
      "<th>rises</th><th class=\"text\">direction (N·m)</th></tr>\n";
  const std::uint64_t all = trial.samples();
  for (std::size_t i = 0; i < urdf::kScoredJoints.size(); ++i) {
    const loads::JointExposure of = trial.exposure().Of(i);
    html +=
        fmt::format("<tr><td>{}</td><td class=\"text\">{}</td>", ScoredLabel(i), BarHtml(of, all));
    const std::uint64_t known = all - of.samples[static_cast<std::size_t>(LoadClass::kUnknown)];
    for (const LoadClass band : kLoadClassesOfTables) {
      const bool is_known = band != LoadClass::kUnknown;
      html += fmt::format("<td>{}</td>", Number(PercentIn(band, of, is_known ? known : all), 1));
    }
    const bool has_peak = std::isfinite(of.peak_ratio);
    html += fmt::format(
        "<td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td "
        "class=\"text\">{}{}</td></tr>\n",
        Number(of.p10, 2), Number(of.p50, 2), Number(of.p90, 2), Number(of.peak_ratio, 2),
        has_peak ? Number(trial.SecsOf(of.peak_stamp_nanos), 2) : "–",
        has_peak ? Number(of.above[1].longest_secs, 2) : "–",
        has_peak ? std::to_string(of.above[1].rises) : "–",
        has_peak ? EscapeHtml(of.peak_channel) : "–",
        has_peak && std::isfinite(of.peak_moment)
            ? fmt::format(", {:.1f} of {:.1f}", std::abs(of.peak_moment), of.peak_capacity)
            : "");
  }
  return html + "</table>\n";
}

std::string LegendHtml(const TrialContext& context) {
  const auto& up = context.scene.loads.meter.up;
  return fmt::format(
      "<p class=\"sub\"><i class=\"key low\"></i>low, ratio up to {0:.2f}"
      "<i class=\"key medium\"></i>medium<i class=\"key high\"></i>high, above {1:.2f}"
      "<i class=\"key unknown\"></i>unknown (of all samples; the others of those known). Longest "
      "time above {1:.2f}, and rises above it. "
      "L5/S1: "
      "the larger ratio of moment and compression{2}.</p>\n",
      up[0], up[1],
      context.scene.loads.compression_counts ? "" : " (compression is switched off here)");
}

std::string PersonHtml(const LoadTrial& trial, const TrialContext& context,
                       render::Renderer& renderer) {
  std::string html = "<main>\n" + HeadHtml(trial, context);
  html += "<h2>Highest loads</h2>\n" + MomentsHtml(trial, renderer);
  html += "<h2>Exposure</h2>\n" + ExposureHtml(trial) + LegendHtml(context);
  html += fmt::format("<h2>Load ratio over time</h2>\n<img class=\"plot\" alt=\"\" src=\"{}\">\n",
                      DataUrl("image/svg+xml", render::ToSvg(OverviewPlot(trial, context))));
  html += "<h2>Assumptions, checks and unknown loads</h2>\n<ul>\n";
  for (const std::string& note : NotesOf(trial, context)) {
    html += "<li>" + EscapeHtml(note) + "</li>\n";
  }
  html += fmt::format("</ul>\n<footer>Kinescope {}. {}</footer>\n</main>\n", KINESCOPE_VERSION,
                      "Method, limits and sources: docs/loads.md.");
  return html;
}

}  // namespace

void WriteReport(const std::map<int, LoadTrial>& trials, const TrialContext& context,
                 const BackendOptions& backend, const std::filesystem::path& path) {
  render::NewFile file(path);  // first: a folder that takes no file is known before the work
  const auto renderer = StartRenderer(backend);
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n"
      "<meta name=\"generator\" content=\"Kinescope {}\">\n<title>Joint loads: {}</title>\n"
      "<style>\n{}\n</style>\n</head>\n<body>\n",
      KINESCOPE_VERSION, EscapeHtml(context.source), Style());
  for (const auto& [character, trial] : trials) html += PersonHtml(trial, context, *renderer);
  html += "</body>\n</html>\n";
  file.Write(html.data(), html.size());
  file.Commit();
}

}  // namespace kinescope::app
