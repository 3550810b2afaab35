#include "server/body/custom_body_meshes.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <vector>

#include "core/system/errors.h"
#include "core/system/words.h"
#include "server/body/mesh_module.h"
#include "urdf/body_surface.h"
#include "urdf/mesh_inputs.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using urdf::At;

constexpr std::size_t kMaxFiles = 10'000;  // of a folder of meshes; more is another folder

bool IsMeshFile(const fs::path& path) {
  const std::string extension = Lower(path.extension().string());
  for (const char* known : {".stl", ".dae", ".obj", ".glb"}) {
    if (extension == known) return true;
  }
  return false;
}

// "xsens_RightForeArm" -> xsens right fore arm; "T8" stays one word.
std::vector<std::string> WordsOf(std::string_view text) {
  std::vector<std::string> words;
  bool begins = true;
  char last = 0;
  for (const char c : text) {
    const auto is = [](int (*kind)(int), char of) {
      return kind(static_cast<unsigned char>(of)) != 0;
    };
    if (!is(std::isalnum, c)) {
      begins = true;
    } else {
      if (begins || (is(std::isupper, c) && is(std::islower, last))) words.emplace_back();
      words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      begins = false;
    }
    last = c;
  }
  return words;
}

std::string CommaJoined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

// By segment. std::map: errors and log name files in the same order everywhere.
std::map<int, fs::path> FilesBySegment(const std::string& folder,
                                       std::vector<std::string>& not_taken) {
  std::error_code error;
  std::map<int, fs::path> files;
  std::vector<fs::path> paths;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (IsMeshFile(entry->path())) paths.push_back(entry->path());
    if (paths.size() > kMaxFiles) {
      throw UsageError(
          fmt::format("--body_model=mesh:{}: more than {} mesh files; expected a folder with the "
                      "meshes of one body",
                      folder, kMaxFiles));
    }
  }
  if (error) throw UsageError(fmt::format("--body_model=mesh:{}: {}", folder, error.message()));
  std::sort(paths.begin(), paths.end());
  for (const fs::path& path : paths) {
    const auto segment = SegmentOfFile(path.stem().string());
    if (!segment) {
      not_taken.push_back(path.filename().string());
      continue;
    }
    const auto [known, is_new] = files.emplace(*segment, path);
    if (!is_new) {
      throw UsageError(
          fmt::format("--body_model=mesh:{}: {} and {} are both meshes of {}; keep one", folder,
                      known->second.filename().string(), path.filename().string(),
                      urdf::kSegments[At(*segment)].mvn_name));
    }
  }
  return files;
}

}  // namespace

std::optional<urdf::Segment> SegmentOfFile(std::string_view stem) {
  std::vector<std::string> words = WordsOf(stem);
  if (!words.empty() && words.front() == "xsens") words.erase(words.begin());
  std::string side;
  std::string name;
  for (const std::string& word : words) {
    const bool is_right = word == "right" || word == "r";
    const bool is_left = word == "left" || word == "l";
    if ((is_right || is_left) && !side.empty()) return std::nullopt;  // both, or twice
    if (is_right) {
      side = "right";
    } else if (is_left) {
      side = "left";
    } else {
      name += word;
    }
  }
  // "rightforearm" in one word has its side in front already.
  const std::string whole = side + name;
  for (int i = 0; i < urdf::kSegmentCount; ++i) {
    if (Lower(std::string(urdf::kSegments[At(i)].mvn_name)) == whole) {
      return static_cast<urdf::Segment>(i);
    }
  }
  return std::nullopt;
}

std::shared_ptr<const CustomBodyMeshes> ReadCustomBodyMeshes(
    const std::string& folder, const urdf::MeshConvention& convention) {
  std::vector<std::string> not_taken;
  const std::map<int, fs::path> files = FilesBySegment(folder, not_taken);
  if (files.empty()) {
    throw UsageError(fmt::format(
        "--body_model=mesh:{}: no mesh file with a segment name found; expected names such "
        "as RightForeArm.stl, xsens_RightForeArm.dae or right_forearm.obj",
        folder));
  }
  auto body = std::make_shared<CustomBodyMeshes>();
  body->fit_person = convention.fits_person;
  std::vector<std::string> missing;
  for (int i = 0; i < urdf::kSegmentCount; ++i) {
    const auto file = files.find(i);
    if (file == files.end()) {
      missing.emplace_back(urdf::kSegments[At(i)].mvn_name);
    } else {
      body->meshes[At(i)] = ReadOwnMesh("--body_model", file->second, convention, i);
    }
  }
  if (!missing.empty()) {
    spdlog::warn("{}: no mesh for {}; using the built-in body model", folder, CommaJoined(missing));
  }
  if (!not_taken.empty()) {
    spdlog::info("files ignored (no segment name): {}", CommaJoined(not_taken));
  }
  return body;
}

std::vector<fs::path> FilesOfCustomBody(const std::string& folder) try {
  std::vector<std::string> not_taken;
  std::vector<fs::path> all;
  for (const auto& [segment, path] : FilesBySegment(folder, not_taken)) {
    for (fs::path& file : urdf::FilesOfMesh(path)) all.push_back(std::move(file));
  }
  return all;
} catch (const UsageError&) {
  return {};
}

urdf::TriangleMesh ReadOwnMesh(const char* option, const fs::path& path,
                               urdf::MeshConvention convention, int segment) {
  const std::string extension = Lower(path.extension().string());
  if (extension == ".dae" || extension == ".glb") {  // these say it, and were read accordingly
    convention.metres_per_unit = 1;
    convention.y_is_up = false;
  }
  urdf::TriangleMesh mesh;
  try {
    mesh = ReadMesh(path);
  } catch (const std::exception& error) {
    throw UsageError(fmt::format("{}: {}", option, error.what()));
  }
  mesh = urdf::ToLinkFrame(std::move(mesh), convention, segment);
  const double size = urdf::BoundsOf(mesh).diagonal().norm();
  constexpr double kSmallest = 0.01;  // m
  constexpr double kLargest = 2.5;
  if (!(size >= kSmallest && size <= kLargest)) {
    throw UsageError(
        fmt::format("{}: {} measures {:.3g} m from corner to corner; expected {} to {} m; set the "
                    "unit of STL and OBJ files with --mesh_units",
                    option, path.string(), size, kSmallest, kLargest));
  }
  return mesh;
}

urdf::TriangleMesh BodyMeshOf(const CustomBodyMeshes* own, const urdf::Skeleton& skeleton,
                              int segment) {
  if (own == nullptr || !own->meshes[At(segment)]) return urdf::SegmentMesh(skeleton, segment);
  const urdf::TriangleMesh& mesh = *own->meshes[At(segment)];
  return own->fit_person ? urdf::FitToPerson(mesh, skeleton, segment) : mesh;
}

}  // namespace kinescope::app
