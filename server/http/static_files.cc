#include "server/http/static_files.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

namespace kinescope::http {
namespace {

namespace fs = std::filesystem;

const char* ContentType(const fs::path& path) {
  static constexpr std::array<std::pair<std::string_view, const char*>, 6> kTypes = {{
      {".html", "text/html; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".ico", "image/x-icon"},
  }};
  const std::string extension = path.extension().string();
  for (const auto& [known, type] : kTypes) {
    if (extension == known) return type;
  }
  return nullptr;
}

bool IsBelow(const fs::path& path, const fs::path& folder) {
  const auto [end, _] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end();
}

bool IsHiddenOrForeign(const fs::path& name) {
  return name.native().front() == '.' || name == "node_modules";
}

// Canonical path if it is a regular file below `root`, empty otherwise.
fs::path Admit(const fs::path& path, const fs::path& root) {
  std::error_code error;
  fs::path canonical = fs::canonical(path, error);
  if (error || !IsBelow(canonical, root) || !fs::is_regular_file(canonical, error)) return {};
  return canonical;
}

// Of a page that was changed since its build, the modules are served.
bool IsNewer(const fs::path& bundle, const std::map<std::string, StaticFile>& files) {
  std::error_code error;
  const auto made = fs::last_write_time(bundle, error);
  return !error && std::all_of(files.begin(), files.end(), [&](const auto& entry) {
    const fs::path& path = entry.second.path;
    return path.extension() != ".js" || fs::last_write_time(path, error) <= made;
  });
}

}  // namespace

const std::vector<Library>& Libraries() {
  static const std::vector<Library> kLibraries = {
      {"/lib/three/three.module.js", "three/build/three.module.js"},
      {"/lib/three/three.core.js", "three/build/three.core.js"},
      {"/lib/three/addons/controls/OrbitControls.js",
       "three/examples/jsm/controls/OrbitControls.js"},
      {"/lib/three/addons/geometries/RoundedBoxGeometry.js",
       "three/examples/jsm/geometries/RoundedBoxGeometry.js"},
      {"/lib/three/addons/loaders/GLTFLoader.js", "three/examples/jsm/loaders/GLTFLoader.js"},
      {"/lib/three/addons/loaders/STLLoader.js", "three/examples/jsm/loaders/STLLoader.js"},
      {"/lib/three/addons/utils/BufferGeometryUtils.js",
       "three/examples/jsm/utils/BufferGeometryUtils.js"},
      {"/lib/three/addons/utils/SkeletonUtils.js", "three/examples/jsm/utils/SkeletonUtils.js"},
      {"/lib/uplot/uPlot.esm.js", "uplot/dist/uPlot.esm.js"},
      {"/lib/uplot/uPlot.min.css", "uplot/dist/uPlot.min.css"},
  };
  return kLibraries;
}

StaticFiles::StaticFiles(const fs::path& web_root, const fs::path& bundle) {
  std::error_code error;
  const fs::path root = fs::canonical(web_root, error);
  if (error) return;
  fs::recursive_directory_iterator entry(root, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (IsHiddenOrForeign(entry->path().filename())) {
      entry.disable_recursion_pending();
      continue;
    }
    const char* type = ContentType(entry->path());
    const fs::path path = type != nullptr ? Admit(entry->path(), root) : fs::path();
    if (!path.empty()) {
      files_["/" + entry->path().lexically_relative(root).generic_string()] = {path, type};
    }
  }
  for (const Library& library : Libraries()) {
    const fs::path path = Admit(root / "node_modules" / library.path, root);
    if (!path.empty()) files_[library.url] = {path, ContentType(path)};
  }
  const auto index = files_.find("/index.html");
  if (index != files_.end()) files_["/"] = index->second;
  const auto modules = files_.find("/app.js");
  if (modules != files_.end() && IsNewer(bundle, files_)) modules->second.path = bundle;
}

const StaticFile* StaticFiles::Find(const std::string& url_path) const {
  const auto found = files_.find(url_path);
  return found == files_.end() ? nullptr : &found->second;
}

std::string EntityTag(const fs::path& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  if (error) return {};
  const auto time = fs::last_write_time(path, error);
  if (error) return {};
  return '"' + std::to_string(time.time_since_epoch().count()) + '-' + std::to_string(size) + '"';
}

}  // namespace kinescope::http
