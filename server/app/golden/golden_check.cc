#include "server/app/golden/golden_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <optional>
#include <stdexcept>
#include <utility>

#include "server/app/golden/picture_check.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Of what could not be drawn: the line that the error names ("FILE:5: …"), else that of the key
// that it names, else that of what is drawn.
int LineOfError(const FoundCase& found, const fs::path& file, const std::string& error) {
  const std::string place = file.string() + ":";
  const std::size_t at = error.find(place);
  const int named = at == std::string::npos ? 0 : std::atoi(error.c_str() + at + place.size());
  if (named > 0) return named;
  if (!found.read) return 1;
  for (const auto& [key, line] : found.read->lines) {
    if (error.find(fmt::format("golden case {}: {}:", found.name, key)) != std::string::npos) {
      return line;
    }
  }
  return LineOf(found, found.read->page->empty() ? "source" : "page");
}

std::vector<CaseVerdict> NotDrawn(const GoldenSuite& suite, const FoundCase& found,
                                  const std::vector<CaseVerdict>& drawn) {
  std::vector<CaseVerdict> verdicts;
  for (const std::string& name : suite.AcceptedPicturesOf(found)) {
    const bool is_drawn = std::any_of(drawn.begin(), drawn.end(),
                                      [&](const CaseVerdict& each) { return each.name == name; });
    if (is_drawn) continue;
    CaseVerdict verdict = VerdictOf(suite, found, std::nullopt);
    verdict.name = name;
    verdict.outcome = Outcome::kDiffers;
    verdict.accepted_pixels = suite.AcceptedOf(name)->pixels_sha256;
    verdict.findings = {
        {FindingKind::kPicture, kWholePicture, "", "", 0,
         fmt::format("is accepted, but the case does not draw it any more; run `kinescope golden "
                     "update {} {}`, which removes it",
                     suite.folder.string(), found.name)}};
    verdicts.push_back(std::move(verdict));
  }
  return verdicts;
}

// What a person asks of a clip: when does it begin to differ?
void NoteFirstDifference(std::vector<CaseVerdict>& verdicts) {
  // A recording that has changed elsewhere is no difference of a picture.
  const auto differs = [](const CaseVerdict& verdict) {
    const auto is_of_picture = [](const GoldenFinding& finding) {
      return finding.kind != FindingKind::kInput;
    };
    return verdict.frame && verdict.outcome != Outcome::kSame &&
           (verdict.findings.empty() ||
            std::any_of(verdict.findings.begin(), verdict.findings.end(), is_of_picture));
  };
  const auto first = std::find_if(verdicts.begin(), verdicts.end(), differs);
  if (first == verdicts.end()) return;
  first->notes.insert(
      first->notes.begin(),
      fmt::format("the clip begins to differ in {}; {} of {} compared pictures are not the same",
                  ToText(*first->frame), std::count_if(first, verdicts.end(), differs),
                  std::count_if(verdicts.begin(), verdicts.end(),
                                [](const CaseVerdict& each) { return each.frame.has_value(); })));
}

CaseVerdict OfNoCase(const std::string& name, const fs::path& file, const std::string& what) {
  CaseVerdict verdict;
  verdict.name = name;
  verdict.file = file;
  verdict.outcome = Outcome::kDiffers;
  verdict.findings = {{FindingKind::kPicture, kWholePicture, "", "", 0, what}};
  return verdict;
}

}  // namespace

fs::path NewPictureOf(const fs::path& out, const std::string& name) {
  return out / (name + ".actual.png");
}

fs::path CompositeOf(const fs::path& out, const std::string& name) {
  return out / (name + ".compare.png");
}

fs::path DifferenceOf(const fs::path& out, const std::string& name) {
  return out / (name + ".diff.png");
}

std::vector<CaseVerdict> CheckCase(const GoldenSuite& suite, const FoundCase& found,
                                   const CheckSettings& settings,
                                   const std::map<std::string, std::string>& environment,
                                   render::Renderer& renderer) {
  std::vector<CaseVerdict> verdicts;
  Clock::time_point begin = Clock::now();
  const auto add = [&](CaseVerdict verdict) {
    verdict.secs = std::chrono::duration<double>(Clock::now() - begin).count();
    begin = Clock::now();
    verdicts.push_back(std::move(verdict));
  };
  const auto not_compared = [&](std::string reason) {
    CaseVerdict verdict = VerdictOf(suite, found, std::nullopt);
    verdict.outcome = Outcome::kNotCompared;
    verdict.line = LineOfError(found, verdict.file, reason);
    verdict.reason = std::move(reason);
    return verdict;
  };
  if (!found.read) return {not_compared(found.error)};
  std::exception_ptr cannot_write;  // which is no fault of the case
  try {
    Draw(*found.read, renderer, [&](GoldenDrawing drawing) {
      CheckMasksOf(found, drawing);
      try {
        add(CheckPicture(suite, found, settings, environment, std::move(drawing)));
      } catch (...) {
        cannot_write = std::current_exception();
        throw;
      }
    });
  } catch (const std::exception& error) {
    if (cannot_write) std::rethrow_exception(cannot_write);
    const fs::path file = suite.CaseFileOf(found);
    const std::string text = error.what();
    const bool names_line = text.find(file.string() + ":") != std::string::npos;
    add(not_compared(names_line ? text
                                : fmt::format("{}:{}: {}", file.string(),
                                              LineOfError(found, file, text), text)));
    return verdicts;
  }
  for (CaseVerdict& missing : NotDrawn(suite, found, verdicts)) add(std::move(missing));
  if (found.read->seconds) NoteFirstDifference(verdicts);
  return verdicts;
}

std::vector<CaseVerdict> VerdictsOfNoCase(const GoldenSuite& suite) {
  const std::string no_case = "belongs to no case: there is no .yaml of this name; ";
  std::vector<CaseVerdict> verdicts;
  for (const fs::path& file : suite.unread) {
    verdicts.push_back(
        OfNoCase(file, suite.folder / file, "is not read: a case is called NAME.yaml; rename it"));
  }
  for (const fs::path& orphan : suite.orphans) {
    verdicts.push_back(
        OfNoCase(orphan, suite.folder / orphan, no_case + "remove it, or write the case"));
  }
  for (const std::string& name : suite.unknown_locks) {
    verdicts.push_back(
        OfNoCase("golden.lock: " + name, suite.lock_file(),
                 no_case + "run `kinescope golden update` to remove the entry, or write the case"));
  }
  return verdicts;
}

}  // namespace kinescope::app
