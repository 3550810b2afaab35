#include "server/app/golden/golden_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "server/app/golden/golden_check.h"
#include "server/app/golden/golden_composite.h"
#include "server/app/golden/golden_report_look.h"
#include "server/app/html.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

constexpr double kNearShare = 0.3;  // of a picture, that is shown enlarged

struct Picture {
  std::string id;   // of the element; "": there is none
  std::string url;  // with its bytes
};

Picture ReadPicture(const fs::path& path, const std::string& id) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  return bytes.empty() ? Picture() : Picture{id, DataUrl("image/png", bytes)};
}

// "low (green)" with a dot of this colour before it.
std::string WithDots(const std::string& text) {
  std::string html;
  std::size_t from = 0;
  for (std::size_t open = text.find('('); open != std::string::npos; open = text.find('(', from)) {
    const std::size_t close = text.find(')', open);
    if (close == std::string::npos) break;
    const std::string inside = text.substr(open + 1, close - open - 1);
    const std::string before = text.substr(from, open - from);
    const std::size_t word = before.size() < 2 ? 0 : before.rfind(' ', before.size() - 2) + 1;
    html += EscapeHtml(before.substr(0, word));
    for (const char* color : {"green", "orange", "red", "grey"}) {
      if (inside == color) html += fmt::format("<i class=\"dot {}\"></i>", color);
    }
    html += EscapeHtml(before.substr(word) + text.substr(open, close + 1 - open));
    from = close + 1;
  }
  return html + EscapeHtml(text.substr(from));
}

// The worst of it, in one clause.
std::string FirstLine(const CaseVerdict& verdict) {
  if (!verdict.reason.empty()) return verdict.reason;
  const std::vector<std::string> lines = Summarize(verdict.findings);
  return lines.empty() ? "" : lines.front().substr(0, lines.front().find("; "));
}

const char* ToneOf(const CaseVerdict& verdict) {
  switch (verdict.outcome) {
    case Outcome::kSame: return "ok";
    case Outcome::kDiffers: return "bad";
    case Outcome::kNotCompared: break;
  }
  return "warn";
}

// The worst first, then those of which nothing is known, then the others; by name among equals.
std::vector<const CaseVerdict*> InOrder(const std::vector<CaseVerdict>& verdicts) {
  const auto rank = [](const CaseVerdict& verdict) {
    if (verdict.outcome == Outcome::kSame) return 200;
    if (verdict.outcome == Outcome::kNotCompared) return 101;
    if (!verdict.now) return 100;  // a file of no case
    return verdict.findings.empty() ? 99 : static_cast<int>(verdict.findings.front().kind);
  };
  std::vector<const CaseVerdict*> all;
  all.reserve(verdicts.size());
  for (const CaseVerdict& verdict : verdicts) all.push_back(&verdict);
  std::stable_sort(all.begin(), all.end(),
                   [&](const CaseVerdict* a, const CaseVerdict* b) { return rank(*a) < rank(*b); });
  return all;
}

// Those of layers stand in their table.
std::vector<GoldenFinding> WithoutLayers(const std::vector<GoldenFinding>& findings) {
  std::vector<GoldenFinding> others;
  for (const GoldenFinding& finding : findings) {
    if (finding.kind < FindingKind::kLight) others.push_back(finding);
  }
  return others;
}

class ReportWriter {
 public:
  ReportWriter(const std::vector<CaseVerdict>& verdicts, const ReportSettings& settings)
      : settings_(settings), verdicts_(InOrder(verdicts)), counts_(CountsOf(verdicts)) {}

  std::string Write() {
    const std::string headline = EscapeHtml(Headline(counts_));
    html_ = fmt::format(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
        "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n"
        "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
        "<title>{} – {}</title>\n<style>{}</style></head>\n<body data-run=\"{}\">\n",
        headline, EscapeHtml(settings_.folder.string()), kGoldenReportStyle,
        EscapeHtml(settings_.out.string()));
    AddTop(headline);
    html_ += "<main>\n";
    AddSummary();
    int number = 0;
    for (const CaseVerdict* verdict : verdicts_) {
      if (verdict->outcome != Outcome::kSame) AddCase(*verdict, ++number);
    }
    html_ += "</main>\n";
    if (counts_.ExitCode() != 0) AddFoot();
    return html_ + "</body></html>\n";
  }

 private:
  void AddTop(const std::string& headline) {
    const char* const tone = counts_.different > 0 ? "bad" : counts_.not_compared > 0 ? "warn" : "";
    html_ +=
        fmt::format("<header class=\"top\"><span class=\"mark {}\">{}</span><div><h1>{}</h1>", tone,
                    counts_.different > 0      ? "✕"
                    : counts_.not_compared > 0 ? "?"
                                               : "✓",
                    headline);
    const CaseVerdict* const worst = verdicts_.empty() ? nullptr : verdicts_.front();
    if (worst != nullptr && worst->outcome != Outcome::kSame) {
      html_ += fmt::format("<p>Worst: <a href=\"#case1\">{}</a>, {}. {} passed. Exit code {}.</p>",
                           EscapeHtml(worst->name), EscapeHtml(FirstLine(*worst)), counts_.same,
                           counts_.ExitCode());
    } else {
      html_ += fmt::format("<p>{} in {}.</p>", counts_.same, EscapeHtml(settings_.folder.string()));
    }
    html_ += "</div></header>\n";
  }

  void AddSummary() {
    html_ +=
        "<section><table class=\"summary\"><thead><tr><th></th><th>case</th><th>in "
        "words</th><th>fails in</th>"
        "<th>what changed</th></tr></thead><tbody>\n";
    int number = 0;
    for (const CaseVerdict* verdict : verdicts_) {
      if (verdict->outcome == Outcome::kSame) continue;
      ++number;
      html_ += fmt::format(
          "<tr><td class=\"number\">{0}</td><td><a href=\"#case{0}\">{1}</a></td><td "
          "class=\"first\">{2}</td><td>{3}</td><td>{4}</td></tr>\n",
          number, EscapeHtml(verdict->name), WithDots(FirstLine(*verdict)), LayerTags(*verdict),
          HasCause(*verdict) ? CauseOf(verdict->changes) : "–");
    }
    html_ += "</tbody></table>\n";
    AddPassed();
    AddEnvironment();
    html_ += "</section>\n";
  }

  static std::string LayerTags(const CaseVerdict& verdict) {
    if (verdict.outcome == Outcome::kNotCompared) {
      return "<span class=\"tag warn\">not compared</span>";
    }
    std::string tags;
    for (const GoldenLayer& layer : verdict.layers) {
      if (!layer.passes) tags += fmt::format("<span class=\"tag bad\">{}</span> ", layer.name);
    }
    return tags.empty() ? "<span class=\"tag bad\">accepted files</span>" : tags;
  }

  void AddPassed() {
    if (counts_.same == 0) return;
    html_ += fmt::format("<p><span class=\"tag ok\">✓ {} passed</span> ", counts_.same);
    const char* separator = "";
    for (const CaseVerdict* verdict : verdicts_) {
      if (verdict->outcome != Outcome::kSame) continue;
      html_ += separator + EscapeHtml(verdict->name);
      if (!verdict->is_byte_equal) html_ += " (within the limits)";
      if (!verdict->notes.empty()) html_ += " (" + EscapeHtml(verdict->notes.front()) + ")";
      separator = ", ";
    }
    html_ += "</p>\n";
  }

  void AddEnvironment() {
    for (const CaseVerdict* verdict : verdicts_) {
      if (!verdict->now) continue;
      html_ += "<details><summary>Environment of this run</summary><dl>";
      html_ += fmt::format("<div><dt>program</dt><dd>kinescope {}</dd></div>", KINESCOPE_VERSION);
      for (const auto& [name, value] : verdict->now->environment) {
        html_ +=
            fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", EscapeHtml(name), EscapeHtml(value));
      }
      html_ += "</dl></details>\n";
      return;
    }
  }

  void AddCase(const CaseVerdict& verdict, int number) {
    html_ += fmt::format(
        "<section class=\"case {}\" id=\"case{}\" data-number=\"{}\" data-name=\"{}\">\n"
        "<div class=\"head\"><span class=\"number\">{}</span><h2>{}</h2><code>{}</code>",
        ToneOf(verdict), number, number, EscapeHtml(verdict.name), number, EscapeHtml(verdict.name),
        EscapeHtml(verdict.file.string()));
    if (verdict.now) {
      html_ +=
          "<span class=\"decide needs-script\"><button data-decision=\"accept\" "
          "aria-pressed=\"false\">Accept <kbd>A</kbd></button><button data-decision=\"reject\" "
          "aria-pressed=\"false\">Reject <kbd>R</kbd></button></span>";
    }
    if (!verdict.why.empty()) {
      html_ += fmt::format("<p class=\"why\">It checks: {}</p>", EscapeHtml(verdict.why));
    }
    html_ += fmt::format("</div>\n<p class=\"headline\">{}</p>\n", EscapeHtml(FirstLine(verdict)));
    if (verdict.outcome == Outcome::kDiffers) AddWords(verdict);
    AddPictures(verdict, number);
    if (verdict.outcome == Outcome::kDiffers) AddFindings(verdict);
    AddCommands(verdict);
    html_ += "</section>\n";
  }

  void AddWords(const CaseVerdict& verdict) {
    html_ += "<div class=\"two\"><ul class=\"words\">";
    for (const std::string& line : Summarize(WithoutLayers(verdict.findings))) {
      html_ += fmt::format("<li>{}</li>\n", WithDots(line));
    }
    html_ += "</ul><div>";
    if (HasCause(verdict)) {
      html_ += fmt::format("<p class=\"cause{}\">{}</p>",
                           CauseOf(verdict.changes) == "program" ? "" : " other",
                           EscapeHtml(CauseText(verdict.changes)));
    }
    AddLayers(verdict);
    html_ += "</div></div>\n";
  }

  void AddFindings(const CaseVerdict& verdict) {
    if (verdict.findings.size() <= Summarize(verdict.findings).size()) return;
    html_ += fmt::format("<details><summary>All {} changes</summary><ul class=\"words\">",
                         verdict.findings.size());
    for (const GoldenFinding& finding : verdict.findings) {
      html_ +=
          fmt::format("<li class=\"{}\">{}</li>\n", Name(finding.kind), WithDots(finding.text));
    }
    html_ += "</ul></details>\n";
  }

  void AddLayers(const CaseVerdict& verdict) {
    if (verdict.layers.empty()) return;
    html_ +=
        "<table class=\"layers\"><thead><tr><th>layer</th><th>found</th></tr>"
        "</thead><tbody>";
    for (const GoldenLayer& layer : verdict.layers) {
      html_ += fmt::format("<tr class=\"{}\"><th>{} {}</th><td>{}</td></tr>",
                           layer.passes ? "" : "fails", layer.passes ? "✓" : "✕", layer.name,
                           EscapeHtml(layer.found));
    }
    html_ += "</tbody></table>";
  }

  void AddPictures(const CaseVerdict& verdict, int number) {
    if (!verdict.now) return;
    const std::string n = std::to_string(number);
    const Picture before = verdict.accepted_pixels.empty()
                               ? Picture()
                               : ReadPicture(settings_.folder / (verdict.name + ".png"), "b" + n);
    const Picture after = ReadPicture(NewPictureOf(settings_.out, verdict.name), "a" + n);
    const Picture difference = ReadPicture(DifferenceOf(settings_.out, verdict.name), "d" + n);
    const bool has_views = !before.id.empty() && !after.id.empty() && !difference.id.empty();
    if (has_views) {
      html_ += "<div class=\"views needs-script\">";
      constexpr const char* kViews[][2] = {{"side", "Side by side"},
                                           {"blink", "Blink"},
                                           {"slider", "Slider"},
                                           {"heat", "Difference"}};
      int key = 0;
      for (const auto& [view, label] : kViews) {
        html_ +=
            fmt::format("<button data-view=\"{}\" aria-pressed=\"{}\">{} <kbd>{}</kbd></button>",
                        view, key == 0, label, key + 1);
        ++key;
      }
      html_ += "</div>\n";
    }
    html_ += "<div class=\"pictures\">";
    AddFigure("Accepted", before, verdict);
    AddFigure("This run", after, verdict);
    AddFigure("Difference", difference, verdict);
    html_ += "</div>\n";
    if (!has_views) return;
    html_ += fmt::format(
        "<div class=\"big\">{}<div class=\"over\">{}</div><span class=\"label\"></span></div>"
        "<input class=\"slide\" type=\"range\" min=\"0\" max=\"100\" value=\"50\" "
        "aria-label=\"Where the accepted picture ends\">\n",
        Reference(before.id, verdict), Reference(after.id, verdict));
  }

  static std::string ViewBox(const CaseVerdict& verdict) {
    return fmt::format("0 0 {} {}", verdict.now->width, verdict.now->height);
  }

  static std::string Reference(const std::string& id, const CaseVerdict& verdict) {
    return fmt::format("<svg class=\"shot\" viewBox=\"{}\"><use href=\"#{}\"/></svg>",
                       ViewBox(verdict), id);
  }

  // Each picture stands in the file once; what else shows it refers to it.
  void AddFigure(const char* caption, const Picture& picture, const CaseVerdict& verdict) {
    if (picture.id.empty()) return;
    html_ += fmt::format(
        "<figure><figcaption><b>{}</b></figcaption><svg class=\"shot\" "
        "viewBox=\"{}\" role=\"img\" aria-label=\"{}: {}\"><image id=\"{}\" "
        "width=\"{}\" height=\"{}\" href=\"{}\"/>",
        caption, ViewBox(verdict), EscapeHtml(verdict.name), caption, picture.id,
        verdict.now->width, verdict.now->height, picture.url);
    for (const render::Tile& mask : verdict.masks) html_ += MaskRect(mask);
    const std::string near = NearOf(verdict);
    html_ += near.empty() ? "</svg>" : fmt::format("<rect {}/></svg>", near);
    if (!near.empty()) {
      html_ += fmt::format("<svg class=\"shot near\" viewBox=\"{}\"><use href=\"#{}\"/></svg>",
                           NearBox(verdict), picture.id);
    }
    html_ += "</figure>";
  }

  static std::string MaskRect(const render::Tile& mask) {
    return fmt::format(
        "<rect class=\"mask\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"><title>masked: not "
        "compared</title></rect>",
        mask.x, mask.y, mask.width, mask.height);
  }

  static std::string NearOf(const CaseVerdict& verdict) {
    const auto part = WorstPart(verdict);
    if (!part) return "";
    return fmt::format("x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"", part->x, part->y,
                       part->width, part->height);
  }

  static std::string NearBox(const CaseVerdict& verdict) {
    const render::Tile part = WorstPart(verdict).value_or(render::Tile());
    return fmt::format("{} {} {} {}", part.x, part.y, part.width, part.height);
  }

  void AddCommands(const CaseVerdict& verdict) {
    if (!verdict.now && verdict.outcome == Outcome::kDiffers) return;  // a file of no case
    html_ += fmt::format(
        "<div class=\"commands\"><span>Draw it again: <code>kinescope golden check {0} {1}</code>"
        "</span>",
        EscapeHtml(settings_.folder.string()), EscapeHtml(verdict.name));
    if (verdict.now) {
      html_ +=
          fmt::format("<span>Accept it as it is: <code>kinescope golden accept {} {}</code></span>",
                      EscapeHtml(settings_.out.string()), EscapeHtml(verdict.name));
    }
    html_ += "</div>\n";
  }

  void AddFoot() {
    html_ += fmt::format(
        "<footer class=\"needs-script\"><b id=\"decisions\">0 decided</b><code id=\"command\">"
        "</code><button id=\"copy\" disabled>Copy</button><span class=\"keys\"><kbd>J</kbd> "
        "<kbd>K</kbd> next, previous · <kbd>A</kbd> accept · <kbd>R</kbd> reject · <kbd>U</kbd> "
        "undo · <kbd>1</kbd> to <kbd>4</kbd> views</span></footer>\n<script>{}</script>\n",
        kGoldenReportScript);
  }

  const ReportSettings& settings_;
  const std::vector<const CaseVerdict*> verdicts_;
  const OutcomeCounts counts_;
  std::string html_;
};

}  // namespace

std::string GoldenReport(const std::vector<CaseVerdict>& verdicts, const ReportSettings& settings) {
  return ReportWriter(verdicts, settings).Write();
}

}  // namespace kinescope::app
