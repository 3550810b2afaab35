#include "server/app/golden/golden_update.h"

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "core/system/errors.h"
#include "core/system/stop_signal.h"
#include "render/image/compare.h"
#include "render/image/new_file.h"
#include "render/image/png_file.h"
#include "server/app/golden/golden_objects.h"
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
void CheckDrawing(const GoldenDrawing& drawing) {
  if (ShowsNothing(drawing.image)) throw std::runtime_error("the picture is of one colour");
  const auto wrong = render::FindSphereMismatches(drawing.image, drawing.spheres);
  if (wrong.empty()) return;
  throw std::runtime_error("sphere colours in the picture do not match the load classes: " +
                           wrong.front());
}

// Empty if it is no file.
std::string ContentOf(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return "";
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

bool IsAccepted(const fs::path& picture, const render::Image& image) {
  std::error_code ignored;
  if (!fs::is_regular_file(picture, ignored)) return false;
  try {
    return render::Compare(render::ReadPng(picture), image, 0).equal();
  } catch (const std::exception&) {
    return false;  // it is damaged
  }
}

// What was written; "unchanged" if nothing was.
std::string Accept(const GoldenSuite& suite, const FoundCase& found, const GoldenDrawing& drawing) {
  const fs::path picture = suite.PictureOf(found), objects = suite.ObjectsOf(found);
  std::string written;
  const std::string spheres = ToJson(drawing.spheres);
  if (!IsAccepted(picture, drawing.image)) {
    written = fs::exists(picture) ? "picture" : "picture (new)";
    render::WritePng(picture, drawing.image);
  }
  if (ContentOf(objects) != spheres) {
    written += written.empty() ? "load spheres" : ", load spheres";
    render::WriteNewFile(objects, spheres);
  }
  return written.empty() ? "unchanged" : "written: " + written + "; check the picture";
}

}  // namespace

void RefuseToAcceptInCi() {
  const char* const ci = std::getenv("CI");
  if (ci == nullptr || *ci == '\0') return;
  throw UsageError(std::string("golden update: CI=") + ci +
                   ": nothing is accepted where no person looks at the pictures; run it on your "
                   "machine, and commit what it writes");
}

int UpdateSuite(const GoldenSuite& suite, render::Renderer& renderer) {
  bool is_complete = true;
  for (const FoundCase& found : suite.cases) {
    if (StopRequested()) throw std::runtime_error("interrupted; the cases before are updated");
    std::optional<GoldenDrawing> drawing;
    try {
      if (!found.read) throw std::runtime_error(found.error);
      drawing = Draw(*found.read, renderer);
      CheckDrawing(*drawing);
    } catch (const std::exception& error) {
      is_complete = false;
      Print("{:<24} NOT ACCEPTED\n  {}\n", found.name, error.what());
      continue;
    }
    Print("{:<24} {}\n", found.name, Accept(suite, found, *drawing));
  }
  return is_complete ? 0 : 2;
}

}  // namespace kinescope::app
