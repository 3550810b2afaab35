#include "server/app/golden/golden_report.h"

#include <fmt/format.h>

#include <cstdint>
#include <fstream>
#include <iterator>

#include "server/app/golden/golden_check.h"
#include "server/app/golden/golden_composite.h"
#include "server/app/golden/golden_report_look.h"
#include "server/app/golden/golden_report_text.h"
#include "server/app/html.h"
#include "server/app/shell_word.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostPictureBytes = 64 << 20;

struct Picture {
  std::string id;   // of the element; "": there is none
  std::string url;  // with its bytes
};

Picture ReadPicture(const fs::path& path, const std::string& id) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored) || fs::file_size(path, ignored) > kMostPictureBytes) {
    return {};
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  return bytes.empty() ? Picture() : Picture{id, DataUrl("image/png", bytes)};
}

const char* ToneOf(const CaseVerdict& verdict) {
  switch (verdict.outcome) {
    case Outcome::kSame: return "ok";
    case Outcome::kDiffers: return "bad";
    case Outcome::kNotCompared: break;
  }
  return "warn";
}

class ReportWriter {
 public:
  ReportWriter(const std::vector<CaseVerdict>& verdicts, const ReportSettings& settings)
      : settings_(settings), verdicts_(InOrder(verdicts)), counts_(CountsOf(verdicts)) {}

  std::string Write() {
    AddHead();
    AddTop();
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
  // What a file may do is in it; what a served page may do, its server says.
  void AddHead() {
    const std::string policy =
        settings_.review
            ? "<link rel=\"icon\" href=\"data:,\">"
            : "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src "
              "data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'\">";
    const std::string token =
        settings_.review ? fmt::format(" data-token=\"{}\"", EscapeHtml(settings_.review->token))
                         : "";
    html_ = fmt::format(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n{}\n"
        "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
        "<title>{}{} – {}</title>\n<style{}>{}</style></head>\n<body data-run=\"{}\"{}>\n",
        policy, settings_.review ? "Review: " : "", EscapeHtml(Headline(counts_)),
        EscapeHtml(settings_.folder.string()), Nonce(), kGoldenReportStyle,
        EscapeHtml(settings_.out.string()), token);
  }

  std::string Nonce() const {
    if (!settings_.review) return "";
    return fmt::format(" nonce=\"{}\"", EscapeHtml(settings_.review->nonce));
  }

  void AddTop() {
    const char* const tone = counts_.different > 0 ? "bad" : counts_.not_compared > 0 ? "warn" : "";
    html_ +=
        fmt::format("<header class=\"top\"><span class=\"mark {}\">{}</span><div><h1>{}</h1>", tone,
                    counts_.different > 0      ? "✕"
                    : counts_.not_compared > 0 ? "?"
                                               : "✓",
                    EscapeHtml(Headline(counts_)));
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
    html_ += fmt::format(
        "<section><table class=\"summary\"><thead><tr><th></th><th>case</th><th>in "
        "words</th><th>fails in</th><th>what changed</th>{}</tr></thead><tbody>\n",
        settings_.review ? "<th>decision</th>" : "");
    int number = 0;
    for (const CaseVerdict* verdict : verdicts_) {
      if (verdict->outcome == Outcome::kSame) continue;
      ++number;
      html_ += fmt::format(
          "<tr><td class=\"number\">{0}</td><td><a href=\"#case{0}\">{1}</a></td><td "
          "class=\"first\">{2}</td><td>{3}</td><td>{4}</td>{5}</tr>\n",
          number, EscapeHtml(verdict->name), WithDots(FirstLine(*verdict)), LayerTags(*verdict),
          HasCause(*verdict) ? CauseOf(verdict->changes) : "–",
          settings_.review ? fmt::format("<td data-decision-of=\"{}\"></td>", number) : "");
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
      if (!layer.passes) {
        tags += fmt::format("<span class=\"tag bad\">{}</span> ", EscapeHtml(layer.name));
      }
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
      html_ += fmt::format("<div><dt>program</dt><dd>kinescope {}</dd></div>",
                           EscapeHtml(settings_.version));
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
        "<section class=\"case {0}\" id=\"case{1}\" data-number=\"{1}\" data-name=\"{2}\" "
        "data-shape=\"{4}\" tabindex=\"-1\" aria-labelledby=\"name{1}\">\n<div "
        "class=\"head\"><span class=\"number\">"
        "{1}</span><h2 id=\"name{1}\">{2}</h2><code>{3}</code>",
        ToneOf(verdict), number, EscapeHtml(verdict.name), EscapeHtml(verdict.file.string()),
        ShapeOf(verdict));
    if (verdict.now) AddDecisions();
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

  // Width by height, of which the style makes what fits into a window; "": there is no picture.
  static std::string ShapeOf(const CaseVerdict& verdict) {
    if (!verdict.now || verdict.now->height < 1) return "";
    return fmt::format("{:.3f}", static_cast<double>(verdict.now->width) / verdict.now->height);
  }

  void AddDecisions() {
    if (settings_.review) html_ += "<span class=\"outcome\"></span>";
    html_ +=
        "<span class=\"decide needs-script\"><button data-decision=\"accept\" "
        "aria-pressed=\"false\">Accept <kbd>A</kbd></button><button data-decision=\"reject\" "
        "aria-pressed=\"false\">Reject <kbd>R</kbd></button>";
    if (settings_.review) {
      html_ += "<button data-decision=\"later\" aria-pressed=\"false\">Later <kbd>L</kbd></button>";
    }
    html_ += "</span>";
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
                           layer.passes ? "" : "fails", layer.passes ? "✓" : "✕",
                           EscapeHtml(layer.name), EscapeHtml(layer.found));
    }
    html_ += "</tbody></table>";
  }

  void AddPictures(const CaseVerdict& verdict, int number) {
    if (!verdict.now) return;
    const std::string n = std::to_string(number);
    const Picture before = verdict.accepted_pixels.empty()
                               ? Picture()
                               : ReadPicture(settings_.pictures / (verdict.name + ".png"), "b" + n);
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
        EscapeHtml(ShellWord(settings_.folder.string())), EscapeHtml(ShellWord(verdict.name)));
    if (verdict.now && !settings_.review) {
      html_ += fmt::format(
          "<span>Accept it as it is: <code>kinescope golden accept {} {}</code></span>",
          EscapeHtml(ShellWord(settings_.out.string())), EscapeHtml(ShellWord(verdict.name)));
    }
    html_ += "</div>\n";
  }

  void AddFoot() {
    html_ += fmt::format(
        "<footer class=\"needs-script\"><b id=\"decisions\">0 decided</b>{}<span class=\"keys\">"
        "<kbd>J</kbd> <kbd>K</kbd> next, previous · <kbd>A</kbd> accept · <kbd>R</kbd> reject · {}"
        "<kbd>U</kbd> undo · <kbd>1</kbd> to <kbd>4</kbd> views</span></footer>\n"
        "<script{}>{}</script>\n",
        settings_.review
            ? "<span id=\"said\" role=\"status\">Accepting writes the picture and "
              "golden.lock at once; U restores them.</span><button id=\"finish\" disabled>"
              "Finish <kbd>F</kbd></button>"
            : "<code id=\"command\"></code><button id=\"copy\" disabled>Copy</button>",
        settings_.review ? "<kbd>L</kbd> later · " : "", Nonce(), kGoldenReportScript);
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
