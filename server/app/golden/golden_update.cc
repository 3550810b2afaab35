#include "server/app/golden/golden_update.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "core/system/errors.h"
#include "core/system/sha256.h"
#include "render/image/png_file.h"
#include "server/app/golden/golden_check.h"
#include "server/app/print.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

// What has changed between them, in words; "": nothing.
std::string WordsFor(const AcceptedCase* before, const AcceptedCase& now) {
  if (before == nullptr) return "";
  const GoldenChanges changes = ChangesBetween(*before, now);
  std::vector<std::string> words;
  if (before->pixels_sha256 != now.pixels_sha256) words.emplace_back("picture");
  if (ToJson(before->facts) != ToJson(now.facts)) words.emplace_back("what it shows");
  if (!changes.options.empty()) words.emplace_back("case");
  if (!changes.inputs.empty()) words.emplace_back("inputs");
  if (!changes.environment.empty()) words.emplace_back("environment");
  return fmt::format("{}", fmt::join(words, ", "));
}

bool IsThere(const fs::path& picture, const std::string& pixels_sha256) {
  std::error_code ignored;
  if (!fs::is_regular_file(picture, ignored)) return false;
  try {
    return PixelsHash(render::ReadPng(picture)) == pixels_sha256;
  } catch (const std::exception&) {
    return false;  // it is damaged
  }
}

class Updating {
 public:
  Updating(GoldenSuite& suite, const fs::path& drawn) : suite_(suite), drawn_(drawn) {}

  bool is_complete() const { return is_complete_; }

  void Take(const CaseVerdict& verdict) {
    const bool is_of_case =
        std::any_of(suite_.cases.begin(), suite_.cases.end(),
                    [&](const FoundCase& each) { return each.name == CaseNameOf(verdict.name); });
    if (!is_of_case) return;  // a file without one
    if (!verdict.now && verdict.outcome == Outcome::kDiffers) return Remove(verdict.name);
    const std::string fault = verdict.now ? FaultOf(verdict) : verdict.reason;
    if (!fault.empty()) {
      is_complete_ = false;
      Print("{:<24} NOT ACCEPTED\n  {}\n", verdict.name, fault);
      return;
    }
    try {
      Print("{:<24} {}\n", verdict.name, Accept(verdict));
    } catch (const std::exception& error) {
      is_complete_ = false;
      Print("{:<24} NOT ACCEPTED\n  {}\n", verdict.name, error.what());
    }
  }

 private:
  void Remove(const std::string& name) {
    suite_.lock.erase(name);
    fs::remove(suite_.PictureOf(name));
    Print("{:<24} removed: the case does not draw it any more\n", name);
  }

  // What was written; "unchanged" if nothing was.
  std::string Accept(const CaseVerdict& verdict) {
    AcceptedCase now = *verdict.now;
    const AcceptedCase* const before = suite_.AcceptedOf(verdict.name);
    const bool is_first = before == nullptr;
    const std::string words = WordsFor(before, now);
    const fs::path picture = suite_.PictureOf(verdict.name);
    const bool is_there = IsThere(picture, now.pixels_sha256);
    if (!is_there) {
      fs::create_directories(picture.parent_path());  // git keeps no empty folders
      render::WritePng(picture, render::ReadPng(NewPictureOf(drawn_, verdict.name)));
    }
    now.file_sha256 = DigestOf(picture).sha256;
    suite_.lock[verdict.name] = std::move(now);
    if (is_first) return "accepted for the first time; check the picture";
    if (!words.empty()) return "accepted: " + words + "; check the picture";
    return is_there ? "unchanged" : "the picture was missing or damaged and is written again";
  }

  GoldenSuite& suite_;
  const fs::path& drawn_;
  bool is_complete_ = true;
};

std::string ContentOf(const GoldenLock& lock) {
  std::string content;
  for (const auto& [name, accepted] : lock) content += name + ToJson(accepted);
  return content;
}

}  // namespace

void RefuseToAcceptInCi() {
  const char* const ci = std::getenv("CI");
  if (ci == nullptr || *ci == '\0') return;
  throw UsageError(std::string("CI=") + ci +
                   ": nothing is accepted where no person looks at the pictures; run it on your "
                   "machine, and commit what it writes");
}

void MovePictures(GoldenSuite& suite, const std::string& folder) {
  std::error_code ignored;
  GoldenSuite moved = suite;
  moved.pictures = fs::proximate(fs::absolute(folder), fs::absolute(suite.folder)).string();
  if (moved.pictures == ".") moved.pictures.clear();
  fs::create_directories(suite.folder / moved.pictures);
  for (const auto& [name, accepted] : suite.lock) {
    const fs::path from = suite.PictureOf(name), to = moved.PictureOf(name);
    if (from == to || !fs::exists(from, ignored)) continue;
    fs::copy_file(from, to, fs::copy_options::overwrite_existing);
    fs::remove(from);
  }
  suite = std::move(moved);
  suite.WriteLockFile();
}

int UpdateSuite(GoldenSuite suite, const JobSettings& jobs, const fs::path& drawn) {
  const GoldenSuite found = suite;  // as the processes find it
  std::string before = ContentOf(suite.lock);
  const auto write = [&] {
    std::string now = ContentOf(suite.lock);
    if (now == before) return;
    suite.WriteLockFile();
    before = std::move(now);
  };
  Updating updating(suite, drawn);
  try {
    CheckInProcesses(found, jobs, [&](const CaseVerdict& verdict) { updating.Take(verdict); });
  } catch (...) {
    write();  // the pictures are there already
    throw;
  }
  for (const std::string& name : suite.unknown_locks) {
    suite.lock.erase(name);
    Print("{:<24} removed from golden.lock: there is no .yaml of this name\n", name);
  }
  write();
  return updating.is_complete() ? 0 : 2;
}

}  // namespace kinescope::app
