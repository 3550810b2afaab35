#include "server/app/golden/golden_accept.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "core/system/errors.h"
#include "core/system/sha256.h"
#include "core/system/words.h"
#include "render/image/new_file.h"
#include "render/image/png_file.h"
#include "server/app/golden/accept_lock.h"
#include "server/app/golden/golden_check.h"
#include "server/app/print.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

std::vector<const CaseVerdict*> Chosen(const GoldenRun& run,
                                       const std::vector<std::string>& names) {
  std::vector<const CaseVerdict*> chosen;
  if (names.empty()) {
    for (const CaseVerdict& each : run.verdicts) {
      if (each.outcome != Outcome::kSame && each.now) chosen.push_back(&each);
    }
    return chosen;
  }
  std::vector<std::string> known;
  for (const CaseVerdict& each : run.verdicts) known.push_back(each.name);
  for (const std::string& name : names) {
    bool is_known = false;
    for (const CaseVerdict& each : run.verdicts) {
      is_known = is_known || CaseNameOf(each.name) == CaseNameOf(name);
      const bool is_of_clip = CaseNameOf(each.name) == name && each.outcome != Outcome::kSame;
      if (each.name == name || is_of_clip) chosen.push_back(&each);
    }
    if (!is_known) {
      throw UsageError(fmt::format("the run has no case '{}'{}", name, SuggestionFor(name, known)));
    }
  }
  return chosen;
}

class Accepting {
 public:
  Accepting(const AcceptSettings& settings, GoldenSuite& suite)
      : settings_(settings), suite_(suite) {}

  /// @throws std::runtime_error why it is not taken.
  void Take(const CaseVerdict& drawn) {
    if (!drawn.now) throw std::runtime_error("was not drawn; `golden check` says why");
    if (const std::string fault = FaultOf(drawn); !fault.empty()) throw std::runtime_error(fault);
    const std::string name = CaseNameOf(drawn.name);
    const auto found = std::find_if(suite_.cases.begin(), suite_.cases.end(),
                                    [&](const FoundCase& each) { return each.name == name; });
    if (found == suite_.cases.end()) throw std::runtime_error("has no .yaml here");
    if (!found->read) throw std::runtime_error(found->error);
    CheckCase(*found, drawn);
    CheckEnvironment(drawn);
    CopyPicture(drawn);
    suite_.lock[drawn.name] = *drawn.now;
  }

 private:
  void CheckCase(const FoundCase& found, const CaseVerdict& drawn) const {
    AcceptedCase here = *drawn.now;
    here.options = found.read->given;
    here.inputs = InputsOf(*found.read);
    const GoldenChanges changes = ChangesBetween(*drawn.now, here);
    if (!changes.options.empty()) {
      throw std::runtime_error(
          fmt::format("its case is not that of the run ({}); run `golden check` again",
                      fmt::join(changes.options, "; ")));
    }
    if (!changes.inputs.empty()) {
      throw std::runtime_error(
          fmt::format("its inputs are not those of the run ({}); run `golden check` again",
                      fmt::join(changes.inputs, "; ")));
    }
    const AcceptedCase* const accepted = suite_.AcceptedOf(drawn.name);
    const std::string pixels = accepted != nullptr ? accepted->pixels_sha256 : "";
    if (pixels == drawn.now->pixels_sha256) return;  // taken already, by another one
    if (pixels != drawn.accepted_pixels) {
      throw std::runtime_error(
          "another picture was accepted since the run; run `golden check` again");
    }
  }

  // As it was accepted before, or as the others of the suite have it.
  void CheckEnvironment(const CaseVerdict& drawn) const {
    if (settings_.takes_other_environment) return;
    const AcceptedCase* const own = suite_.AcceptedOf(drawn.name);
    if (own != nullptr && own->environment == drawn.now->environment) return;
    for (const auto& [name, accepted] : suite_.lock) {
      const GoldenChanges changes = ChangesBetween(accepted, *drawn.now);
      const bool is_alike = accepted.environment.count("browser") ==
                            drawn.now->environment.count("browser");  // scenes or pages
      if (!is_alike || accepted.environment.empty() || changes.environment.empty()) continue;
      throw std::runtime_error(
          fmt::format("was drawn in another environment than {} ({}); draw it there, or take it "
                      "with --other_environment",
                      name, fmt::join(changes.environment, "; ")));
    }
  }

  void CopyPicture(const CaseVerdict& drawn) const {
    const fs::path from = NewPictureOf(settings_.run, drawn.name);
    if (PixelsHash(render::ReadPng(from)) != drawn.now->pixels_sha256 ||
        DigestOf(from).sha256 != drawn.now->file_sha256) {
      throw std::runtime_error(from.string() + ": is not the picture of the run; its hash differs");
    }
    std::ifstream file(from, std::ios::binary);
    render::WriteNewFile(suite_.PictureOf(drawn.name),
                         std::string(std::istreambuf_iterator<char>(file), {}));
  }

  const AcceptSettings& settings_;
  GoldenSuite& suite_;
};

}  // namespace

fs::path FolderFor(const GoldenRun& run, const AcceptSettings& settings) {
  return settings.folder.empty() ? run.folder : fs::path(settings.folder);
}

GoldenSuite SuiteFor(const GoldenRun& run, const AcceptSettings& settings) {
  return FindGoldenSuite(FolderFor(run, settings), {});
}

void TakeCase(const CaseVerdict& drawn, const AcceptSettings& settings, GoldenSuite& suite) {
  Accepting(settings, suite).Take(drawn);
}

int AcceptRun(const AcceptSettings& settings) {
  const GoldenRun run = ReadRun(settings.run);
  const auto chosen = Chosen(run, settings.names);
  if (chosen.empty()) {
    Print("The run has nothing to accept: every case that was drawn is the same\n");
    return 0;
  }
  const AcceptLock lock(FolderFor(run, settings));
  GoldenSuite suite = SuiteFor(run, settings);
  std::size_t taken = 0;
  for (const CaseVerdict* each : chosen) {
    try {
      TakeCase(*each, settings, suite);
      ++taken;
      Print("{:<24} accepted\n", each->name);
    } catch (const std::exception& error) {
      Print("{:<24} NOT ACCEPTED\n  {}\n", each->name, error.what());
    }
  }
  if (taken > 0) suite.WriteLockFile();
  return taken == chosen.size() ? 0 : 2;
}

}  // namespace kinescope::app
