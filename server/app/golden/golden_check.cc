#include "server/app/golden/golden_check.h"

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "core/system/starts_with.h"
#include "core/system/stop_signal.h"
#include "render/image/compare.h"
#include "render/image/new_file.h"
#include "render/image/png_file.h"
#include "server/app/golden/golden_objects.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// What is accepted of a case.
struct Accepted {
  render::Image image;
  std::vector<render::SphereInPicture> spheres;
};

// What Git LFS leaves in the place of a file that it has not fetched.
bool IsLfsPointer(const fs::path& path) {
  std::string begin(64, '\0');
  std::ifstream(path, std::ios::binary).read(begin.data(), 64);
  return StartsWith(begin, "version https://git-lfs");
}

std::string UpdateCommand(const GoldenSuite& suite, const FoundCase& found) {
  return fmt::format("kinescope golden update {} {}", suite.folder.string(), found.name);
}

/// @throws std::runtime_error with the file, the reason and the way out.
Accepted ReadAccepted(const GoldenSuite& suite, const FoundCase& found) {
  const fs::path picture = suite.PictureOf(found), objects = suite.ObjectsOf(found);
  for (const fs::path& file : {picture, objects}) {
    if (!fs::exists(file)) {
      throw std::runtime_error(
          fmt::format("{}: no such file; look at the new picture, then run `{}`", file.string(),
                      UpdateCommand(suite, found)));
    }
    if (IsLfsPointer(file)) {
      throw std::runtime_error(
          file.string() + ": a pointer of Git LFS, whose file is not here; run `git lfs pull`");
    }
  }
  return {render::ReadPng(picture), ReadObjects(objects)};
}

std::string SizeText(const render::Image& image) {
  return fmt::format("{}x{}", image.width, image.height);
}

// The most telling first: what it shows, then how it looks.
std::vector<std::string> Differences(const Accepted& accepted, const GoldenDrawing& drawing) {
  std::vector<std::string> problems = FindObjectChanges(accepted.spheres, drawing.spheres);
  for (std::string& mismatch : render::FindSphereMismatches(drawing.image, drawing.spheres)) {
    problems.push_back(std::move(mismatch));
  }
  if (drawing.frame_code && !(render::ReadFrameCode(drawing.image) == drawing.frame_code)) {
    problems.push_back(fmt::format("frame code: expected sample {}, {} ms",
                                   drawing.frame_code->counter,
                                   drawing.frame_code->time_code_millis));
  }
  const render::Comparison comparison = render::Compare(accepted.image, drawing.image);
  if (!comparison.same_size) {
    problems.push_back(fmt::format("size of the picture: expected {}, found {}",
                                   SizeText(accepted.image), SizeText(drawing.image)));
  } else if (!comparison.equal()) {
    problems.push_back(render::Describe(comparison, drawing.image));
  }
  return problems;
}

void WriteDrawing(const fs::path& out, const std::string& name, const GoldenDrawing& drawing) {
  fs::create_directories(out);
  const std::string base = out / name;
  render::WritePng(base + ".actual.png", drawing.image);
  render::WriteNewFile(base + ".objects.json", ToJson(drawing.spheres));
}

/// @throws std::exception why the case cannot be drawn.
GoldenDrawing DrawingOf(const FoundCase& found, render::Renderer& renderer) {
  if (!found.read) throw std::runtime_error(found.error);
  return Draw(*found.read, renderer);
}

CaseVerdict Check(const GoldenSuite& suite, const FoundCase& found, const CheckSettings& settings,
                  render::Renderer& renderer) {
  CaseVerdict verdict;
  verdict.name = found.name;
  verdict.file = suite.folder / (found.name + ".yaml");
  if (found.read) verdict.why = *found.read->why;
  const auto cannot = [&](const std::exception& error) {
    const std::string where = found.read ? verdict.file.string() + ": " : "";  // else it has it
    verdict.outcome = Outcome::kNotCompared;
    verdict.problems = {where + error.what()};
    return verdict;
  };
  std::optional<GoldenDrawing> drawing;
  try {
    drawing = DrawingOf(found, renderer);
  } catch (const std::exception& error) {
    return cannot(error);
  }
  std::optional<Accepted> accepted;
  try {
    accepted = ReadAccepted(suite, found);
  } catch (const std::exception& error) {
    WriteDrawing(settings.out, found.name, *drawing);
    return cannot(error);
  }
  verdict.problems = Differences(*accepted, *drawing);
  if (verdict.problems.empty()) return verdict;
  verdict.outcome = Outcome::kDiffers;
  WriteDrawing(settings.out, found.name, *drawing);
  render::WritePng((settings.out / found.name).string() + ".diff.png",
                   render::DiffImage(accepted->image, drawing->image));
  return verdict;
}

void StopIfRequested(std::size_t finished, std::size_t all) {
  if (!StopRequested()) return;
  throw std::runtime_error(fmt::format("interrupted after {} of {} cases", finished, all));
}

}  // namespace

const char* Name(Outcome outcome) {
  switch (outcome) {
    case Outcome::kSame: return "same";
    case Outcome::kDiffers: return "differs";
    case Outcome::kNotCompared: break;
  }
  return "not compared";
}

void CheckSuite(const GoldenSuite& suite, const CheckSettings& settings, render::Renderer& renderer,
                const std::function<void(const CaseVerdict&)>& report) {
  std::size_t finished = 0;
  for (const FoundCase& found : suite.cases) {
    StopIfRequested(finished++, suite.cases.size());
    const Clock::time_point begin = Clock::now();
    CaseVerdict verdict = Check(suite, found, settings, renderer);
    verdict.secs = std::chrono::duration<double>(Clock::now() - begin).count();
    report(verdict);
  }
  for (const fs::path& orphan : suite.orphans) {
    CaseVerdict verdict;
    verdict.name = orphan;
    verdict.file = suite.folder / orphan;
    verdict.outcome = Outcome::kDiffers;
    verdict.problems = {
        "belongs to no case: there is no .yaml of this name; remove it, or write the case"};
    report(verdict);
  }
}

void OutcomeCounts::Add(Outcome outcome) {
  switch (outcome) {
    case Outcome::kSame: ++same; break;
    case Outcome::kDiffers: ++different; break;
    case Outcome::kNotCompared: ++not_compared; break;
  }
}

int OutcomeCounts::ExitCode() const {
  if (not_compared > 0) return 2;
  return different > 0 ? 1 : 0;
}

}  // namespace kinescope::app
