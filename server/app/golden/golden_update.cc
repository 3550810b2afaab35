#include "server/app/golden/golden_update.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "core/system/errors.h"
#include "core/system/sha256.h"
#include "core/system/stop_signal.h"
#include "render/image/png_file.h"
#include "server/app/golden/golden_check.h"
#include "server/app/print.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

bool ShowsNothing(const render::Image& image) {
  const std::uint8_t* const first = image.rgba.data();
  for (std::size_t at = 0; at < image.rgba.size(); at += 4) {
    if (std::memcmp(first, first + at, 4) != 0) return false;
  }
  return true;
}

/// @throws std::runtime_error why the drawing must not be accepted.
void CheckDrawing(const GoldenCase& golden_case, const GoldenDrawing& drawing) {
  CheckMasks(*golden_case.masks, drawing.image.width, drawing.image.height);
  if (ShowsNothing(drawing.image)) throw std::runtime_error("the picture is of one colour");
  const auto wrong = render::FindSphereMismatches(drawing.image, drawing.spheres);
  if (wrong.empty()) return;
  throw std::runtime_error("sphere colours in the picture do not match the load classes: " +
                           wrong.front());
}

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

// What was written; "unchanged" if nothing was.
std::string Accept(GoldenSuite& suite, const FoundCase& found, const GoldenDrawing& drawing,
                   const std::map<std::string, std::string>& environment) {
  const std::string name = PictureName(found.name, drawing.frame);
  AcceptedCase now = Describe(*found.read, drawing, environment);
  const AcceptedCase* const before = suite.AcceptedOf(name);
  const std::string words = WordsFor(before, now);
  const fs::path picture = suite.PictureOf(name);
  const bool is_there = IsThere(picture, now.pixels_sha256);
  if (!is_there) render::WritePng(picture, drawing.image);
  now.file_sha256 = DigestOf(picture).sha256;
  suite.lock[name] = std::move(now);
  if (before == nullptr) return "accepted for the first time; check the picture";
  if (!words.empty()) return "accepted: " + words + "; check the picture";
  return is_there ? "unchanged" : "the picture was missing or damaged and is written again";
}

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

int UpdateSuite(GoldenSuite suite, render::Renderer& renderer) {
  const auto environment = EnvironmentOf(renderer.info());
  const std::string before = ContentOf(suite.lock);
  bool is_complete = true;
  for (const FoundCase& found : suite.cases) {
    if (StopRequested()) throw std::runtime_error("interrupted; nothing is accepted");
    std::vector<std::string> left = suite.AcceptedPicturesOf(found);
    try {
      if (!found.read) throw std::runtime_error(found.error);
      Draw(*found.read, renderer, [&](const GoldenDrawing& drawing) {
        CheckDrawing(*found.read, drawing);
        const std::string name = PictureName(found.name, drawing.frame);
        Print("{:<24} {}\n", name, Accept(suite, found, drawing, environment));
        left.erase(std::remove(left.begin(), left.end(), name), left.end());
      });
    } catch (const std::exception& error) {
      is_complete = false;
      Print("{:<24} NOT ACCEPTED\n  {}\n", found.name, error.what());
      continue;
    }
    for (const std::string& name : left) {
      suite.lock.erase(name);
      fs::remove(suite.PictureOf(name));
      Print("{:<24} removed: the case does not draw it any more\n", name);
    }
  }
  for (const std::string& name : suite.unknown_locks) {
    suite.lock.erase(name);
    Print("{:<24} removed from golden.lock: there is no .yaml of this name\n", name);
  }
  if (ContentOf(suite.lock) != before) WriteLock(suite.lock_file(), suite.lock);
  return is_complete ? 0 : 2;
}

}  // namespace kinescope::app
