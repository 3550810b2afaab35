#include "server/app/loads/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/system/words.h"
#include "server/app/html.h"
#include "server/app/loads/report_figures.h"
#include "server/app/loads/report_finding.h"
#include "server/app/loads/report_notes.h"
#include "server/app/loads/report_table.h"
#include "server/app/loads/report_text.h"
#include "server/table/load_rows.h"

namespace kinescope::app {
namespace {

// Sizes are those of the printed page; the screen shows the page. Neither grid nor flexible boxes:
// converters to PDF know them in part. The font is the narrow one that most machines have: a wider
// one would need a second page.
constexpr const char* kReportStyle = R"(@page { size: A4; margin: 7mm 12mm 6mm; }
* { box-sizing: border-box; }
body { margin: 0; background: #e9ebee; color: #21262f; font: 7.2pt/1.27 Arial, "Liberation Sans", Helvetica, sans-serif;
  -webkit-print-color-adjust: exact; print-color-adjust: exact; }
main { width: 210mm; margin: 6mm auto; padding: 7mm 12mm 6mm; background: #fff; }
h1 { font-size: 13pt; line-height: 1.15; margin: 0; overflow-wrap: anywhere; }
h2 { font-size: 8.6pt; line-height: 1.2; margin: 1.7mm 0 .5mm; }
h2 small { font-size: 7pt; font-weight: normal; color: #4d535d; margin-left: 1mm; }
p { margin: 0; } .sub { color: #4d535d; }
table { border-collapse: collapse; border-spacing: 0; }
.lay { width: 186mm; table-layout: fixed; } .lay > tbody > tr > td { vertical-align: top; padding: 0; }
.sign { width: 62mm; } .sign table { width: 62mm; table-layout: fixed; color: #4d535d; }
.sign td { height: 9mm; vertical-align: top; padding: 0 0 0 3mm; } .sign div { height: 9mm; border-bottom: .25mm solid #21262f; }
.facts { margin: 1mm 0 1.3mm; line-height: 1.55; }
.facts span { display: inline-block; max-width: 186mm; margin-right: 3.4mm; color: #4d535d; overflow-wrap: anywhere; } .facts b { color: #21262f; }
.facts .as { border: .25mm dashed #21262f; padding: .1mm .8mm; background: #fff3dc; }
.find { border: .25mm solid #21262f; border-left: 1.6mm solid #61666f; padding: .8mm 2mm; font-size: 8.2pt; line-height: 1.28; } .high { border-left-color: #a80f0f; }
.ex, .se { width: 100%; line-height: 1.16; }
.ex th, .se th { font-weight: normal; text-align: left; white-space: nowrap; padding: 0; border-top: .1mm solid #e0e2e6; }
.ex thead th, .se thead th { color: #4d535d; text-align: right; vertical-align: bottom; line-height: 1.1; padding: 0 0 .4mm 1mm; border-top: 0; border-bottom: .25mm solid #21262f; }
.ex td, .se td { text-align: right; white-space: nowrap; padding: .28mm 0 .28mm 1mm; border-top: .1mm solid #e0e2e6; }
.ex .b { padding-left: 2mm; } .ex .b svg { display: block; }
.ex .p { padding-left: 2.5mm; } .ex .c { color: #4d535d; padding-left: 1.1mm; }
.ex .z, .ex .z.c { color: #7b818b; }
.ex .tx { text-align: left; padding-left: 2.4mm; width: 100%; }
.ex .hi th, .ex .hi td:nth-child(7), .ex .ov { font-weight: bold; }
.ex .grp th, .ex .grp td { border-top: .25mm solid #9aa0a9; }
.ex td:nth-child(11) { padding-left: 3mm; } .ex, .se { border-bottom: .1mm solid #9aa0a9; }
.key { color: #4d535d; margin-top: .8mm; } .key svg { vertical-align: -.2mm; }
.shots { width: 84mm; table-layout: fixed; } .shots td { width: 28mm; vertical-align: top; padding: 0 1.2mm 0 0; line-height: 1.2; overflow-wrap: anywhere; }
.shots img { width: 26.6mm; height: 30.4mm; display: block; border: .15mm solid #c9ccd2; margin-bottom: .5mm; }
.fig svg { display: block; }
.box { border: .25mm solid #21262f; margin-top: 1.4mm; } .box > tbody > tr > td { padding: 0 2mm 1mm; } .box h2 { margin-top: 1mm; }
.box ul { margin: 0; padding: 0; list-style: none; } .box li { padding-left: 2.4mm; text-indent: -2.4mm; overflow-wrap: anywhere; }
.se .base th, .se .base td { font-weight: bold; } .se + p { margin-top: .6mm; }
.foot { color: #4d535d; margin-top: 1.2mm; overflow-wrap: anywhere; font-size: 7pt; }
.foot code { font: 7pt "DejaVu Sans Mono", "Liberation Mono", Consolas, monospace; color: #21262f; }
@media print {
  body { background: #fff; }
  main { width: auto; margin: 0; padding: 0; break-after: page; }
  main:last-child { break-after: auto; }
}
)";

constexpr double kPageMm = 186;  // width of the text
constexpr double kTitlePt = 13, kBodyPt = 7.2, kFindingPt = 8.2, kFootPt = 7, kCommandPt = 7.8;
constexpr double kTitleMm = 120, kFindingMm = 180, kNoteMm = 80;  // widths of a line
constexpr double kNameMm = 50, kFactMm = 75;                      // of one line at most
constexpr int kMostMarkLines = 2;
constexpr int kMostTitleLines = 2, kMostDetailLines = 3, kMostCommandLines = 2;

// Lines of a text that is broken at words.
int LinesOf(double width_mm, double line_mm) {
  constexpr double kRagged = 1.05;
  return std::max(1, static_cast<int>(std::ceil(kRagged * width_mm / line_mm)));
}

std::string TitleOfPage(const ReportPage& page) {
  return Shortened("Joint loads of one trial: " + page.context.source, kTitlePt,
                   0.94 * kMostTitleLines * kTitleMm);
}

std::string HeadHtml(const ReportPage& page) {
  const LoadTrial& trial = page.trial;
  const TrialContext& context = page.context;
  const PersonState& person = trial.newest();
  std::string who = fmt::format("Person {}", person.character);
  if (!person.name.empty()) who += fmt::format(", “{}”", Shortened(person.name, kBodyPt, kNameMm));
  std::string line =
      fmt::format("{} · {:.2f} s, {}", who, trial.secs(), Counted(trial.samples(), "sample"));
  if (context.rate_hz > 0) line += fmt::format(" at {:g} Hz", context.rate_hz);
  if (trial.newest().sample.has_time_of_day) {
    const std::string time = IsoTime(trial.curves().front().stamp_nanos);
    line += fmt::format(" · {} {} UTC", time.substr(0, 10), time.substr(11, 8));
  } else {
    line += " · date and time unknown";
  }
  std::string html = fmt::format(
      "<table class=\"lay\"><tr><td><h1>{}</h1><p "
      "class=\"sub\">{}</p></td><td class=\"sign\"><table><tr><td "
      "style=\"width:40mm\"><div>Checked "
      "by</div></td><td><div>Date</div></td></tr></table></td></tr></table>\n<p class=\"facts\">",
      EscapeHtml(TitleOfPage(page)), EscapeHtml(line));
  for (const Fact& fact : HeadFactsOf(trial, context)) {
    html += fmt::format("<span>{} <b{}>{}{}</b></span> ", EscapeHtml(fact.label),
                        fact.is_assumed ? " class=\"as\"" : "",
                        EscapeHtml(Shortened(fact.value, kBodyPt, kFactMm)),
                        fact.is_assumed ? ", assumed" : "");
  }
  return html + "</p>\n";
}

Finding ShortFindingOf(const ReportPage& page) {
  Finding finding = FindingOf(page.trial, page.context);
  finding.details = Shortened(finding.details, kFindingPt, kMostDetailLines * kFindingMm);
  return finding;
}

std::string FindingHtml(const ReportPage& page) {
  const Finding finding = ShortFindingOf(page);
  return fmt::format("<p class=\"find{}\"><b>{}</b> {}</p>\n", finding.is_high ? " high" : "",
                     EscapeHtml(finding.headline), EscapeHtml(finding.details));
}

std::string PicturesHtml(const std::vector<ReportPicture>& pictures) {
  if (pictures.empty()) return "<p>No load could be computed at any time.</p>";
  std::string html = "<table class=\"shots\"><tr>";
  for (const ReportPicture& picture : pictures) {
    html += fmt::format("<td><img alt=\"{1}\" src=\"{0}\"><b>{1}</b> {2}</td>", picture.url,
                        EscapeHtml(picture.title), EscapeHtml(picture.lines));
  }
  for (std::size_t i = pictures.size(); i < 3; ++i) html += "<td></td>";
  return html + "</tr></table>";
}

// As many as there is room for.
std::string NotesHtml(const std::vector<std::string>& notes, int most_lines) {
  std::string html = "<ul>";
  int lines = 0;
  for (std::size_t i = 0; i < notes.size(); ++i) {
    const int left = most_lines - lines - (i + 1 < notes.size() ? 1 : 0);
    const int needed = LinesOf(TextWidthMm(notes[i], kBodyPt), kNoteMm);
    if (needed > left && i > 0) {
      html += fmt::format("<li>… and {} more, in the notes of --json.</li>", notes.size() - i);
      break;
    }
    lines += std::min(needed, left);
    html += fmt::format("<li>– {}</li>",
                        EscapeHtml(Shortened(notes[i], kBodyPt, 0.95 * left * kNoteMm)));
  }
  return html + "</ul>";
}

std::string FootText(const ReportPage& page) {
  return fmt::format("Kinescope {} · {} · {} · ", KINESCOPE_VERSION,
                     Shortened(page.context.source, kFootPt, kPageMm), page.origin.digest);
}

std::string CommandOf(const ReportPage& page) {
  const std::string& whole = page.origin.command;
  const std::string shown = Shortened(whole, kCommandPt, kMostCommandLines * kPageMm);
  return shown.size() < whole.size() ? shown + " (all: options in --json)" : shown;
}

// "Marks: 1 belt slipped (3.20 s; 0.82 right knee, 3120 N) · ..."; "": none.
std::string MarksText(const ReportPage& page) {
  std::string text;
  constexpr std::size_t kMostMarksBytes = 2000;  // more than there is room for
  for (std::size_t i = 0; i < page.context.marks.size() && text.size() < kMostMarksBytes; ++i) {
    const TrialMark& mark = page.context.marks[i];
    text += fmt::format("{}{} {} ({}; {})", i == 0 ? "" : " · ", i + 1, mark.text, TimesText(mark),
                        LoadsText(LoadsAround(mark, page.trial)));
  }
  const std::string shown = Shortened(text, kBodyPt, kMostMarkLines * 0.95 * kPageMm);
  return shown.size() < text.size() ? shown + " (all: marks in --json)" : shown;
}

std::string MarksHtml(const ReportPage& page) {
  if (page.context.marks.empty()) return "";
  return "<p><b>Marks</b>, with the highest loads around them: " + EscapeHtml(MarksText(page)) +
         "</p>\n";
}

// What the texts of any length above and below the figures take of the page, beyond the usual, mm.
double LongTextsMm(const ReportPage& page) {
  constexpr double kBold = 1.08, kFactGapMm = 6;
  constexpr double kTitleLineMm = 5.3, kFactLineMm = 3.95, kFindingLineMm = 3.7, kFootLineMm = 3.15;
  constexpr int kUsualFactLines = 2, kUsualFindingLines = 3, kUsualFootLines = 2;
  double facts_mm = 0;
  for (const Fact& fact : HeadFactsOf(page.trial, page.context)) {
    facts_mm += kFactGapMm + kBold * std::min(kFactMm, TextWidthMm(fact.value, kBodyPt)) +
                TextWidthMm(fact.label + (fact.is_assumed ? ", assumed" : ""), kBodyPt);
  }
  const Finding finding = ShortFindingOf(page);
  const double finding_mm =
      kBold * TextWidthMm(finding.headline, kFindingPt) + TextWidthMm(finding.details, kFindingPt);
  const double foot_mm =
      TextWidthMm(FootText(page), kFootPt) + TextWidthMm(CommandOf(page), kCommandPt);
  constexpr double kMarkLineMm = 3.25, kMarksHeadMm = 62;
  const double marks_mm =
      page.context.marks.empty()
          ? 0
          : kMarkLineMm * LinesOf(kMarksHeadMm + TextWidthMm(MarksText(page), kBodyPt), kPageMm);
  return marks_mm +
         kTitleLineMm * (LinesOf(kBold * TextWidthMm(TitleOfPage(page), kTitlePt), kTitleMm) - 1) +
         kFactLineMm * std::max(0, LinesOf(facts_mm, kPageMm) - kUsualFactLines) +
         kFindingLineMm * std::max(0, LinesOf(finding_mm, kFindingMm) - kUsualFindingLines) +
         kFootLineMm * std::max(0, LinesOf(foot_mm, kPageMm) - kUsualFootLines);
}

// The figure over time gives way to long texts, then the notes.
double TimeFigureMm(const ReportPage& page) {
  constexpr double kTallest = 55, kLeast = 49;
  return std::clamp(kTallest - LongTextsMm(page), kLeast, kTallest);
}

int LinesForNotes(const ReportPage& page) {
  constexpr double kFigureGivesMm = 6, kNoteLineMm = 3.25;
  constexpr int kAll = 11, kLeast = 4;
  const double more_mm = std::max(0.0, LongTextsMm(page) - kFigureGivesMm);
  return std::clamp(kAll - static_cast<int>(std::ceil(more_mm / kNoteLineMm)), kLeast, kAll);
}

std::string FiguresHtml(const ReportPage& page) {
  const double high = page.context.scene.loads.meter.up[1];
  return fmt::format(
      "<table class=\"lay\"><tr><td style=\"width:86mm\"><h2>Worst postures <small>at least {:.2g} "
      "s apart</small></h2>{}</td><td "
      "class=\"fig\"><h2>Over time <small>dark: above {:g}; hatched: "
      "unknown</small></h2>{}</td></tr>"
      "</table>\n{}<h2>Amplitude distribution <small>% of known samples at or below a ratio "
      "(APDF); "
      "dots: P10, P50, P90; right solid, left dashed and hollow; shaded: above "
      "{:g}</small></h2>\n<div class=\"fig\">{}</div>\n",
      page.trial.apart_secs(), PicturesHtml(page.pictures), high,
      TimeFigure(page.trial, page.context, TimeFigureMm(page)), MarksHtml(page), high,
      DistributionFigure(page.trial, page.context));
}

std::string MethodHtml(const ReportPage& page) {
  return fmt::format(
      "<table class=\"lay box\"><tr><td style=\"width:89mm\"><h2>Method</h2><p>{}</p>"
      "<h2>How far to believe it</h2>{}</td><td><h2>What would change the answer</h2>{}</td></tr>"
      "</table>\n",
      EscapeHtml(MethodText(page.trial, page.context)),
      NotesHtml(TrustNotesOf(page.trial, page.context), LinesForNotes(page)),
      SensitivityTable(page.sensitivity, page.context.scene.loads.meter.up));
}

std::string FootHtml(const ReportPage& page) {
  return fmt::format(
      "<p class=\"foot\">{}repeat: <code>{}</code> · same input, same bytes · method and sources: "
      "docs/loads.md · page {} of {}</p>\n",
      EscapeHtml(FootText(page)), EscapeHtml(CommandOf(page)), page.number, page.count);
}

}  // namespace

std::string ReportDocument(const TrialContext& context, const std::string& pages) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n"
      "<meta name=\"generator\" content=\"Kinescope {}\">\n<title>Joint loads: {}</title>\n"
      "<style>\n{}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
      KINESCOPE_VERSION, EscapeHtml(context.source), kReportStyle, pages);
}

std::string PageHtml(const ReportPage& page) {
  return "<main>\n" + HeadHtml(page) + FindingHtml(page) +
         "<h2>Exposure <small>by the ratio of every sample: no display filter, no hold, no "
         "hysteresis</small></h2>\n" +
         ExposureTable(page.trial, page.context) + FiguresHtml(page) + MethodHtml(page) +
         FootHtml(page) + "</main>\n";
}

}  // namespace kinescope::app
