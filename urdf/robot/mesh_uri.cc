#include "urdf/robot/mesh_uri.h"

#include <cctype>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

namespace kinescope::urdf {
namespace {

namespace fs = std::filesystem;

// As much of a tree as a workspace has; a path entry such as "/" must not be walked to its end.
constexpr int kMaxDepth = 5;
constexpr int kMaxFolders = 20'000;
constexpr std::streamsize kMaxManifestBytes = 4096;  // <name> stands near the beginning

bool IsFile(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

bool TakePrefix(std::string_view& text, std::string_view prefix) {
  if (text.substr(0, prefix.size()) != prefix) return false;
  text.remove_prefix(prefix.size());
  return true;
}

std::string PercentDecoded(std::string_view text) {
  const auto is_hex = [&](std::size_t at) {
    return at < text.size() && std::isxdigit(static_cast<unsigned char>(text[at])) != 0;
  };
  std::string decoded;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '%' && is_hex(at + 1) && is_hex(at + 2)) {
      decoded += static_cast<char>(std::stoi(std::string(text.substr(at + 1, 2)), nullptr, 16));
      at += 2;
    } else {
      decoded += text[at];
    }
  }
  return decoded;
}

// <name> of its package.xml; "" where there is none.
std::string NameInManifest(const fs::path& folder) {
  const fs::path manifest = folder / "package.xml";
  if (!IsFile(manifest)) return "";
  std::string text(static_cast<std::size_t>(kMaxManifestBytes), '\0');
  std::ifstream file(manifest, std::ios::binary);
  file.read(text.data(), kMaxManifestBytes);
  text.resize(static_cast<std::size_t>(file.gcount()));
  const std::string open = "<name>";
  const std::size_t begin = text.find(open);
  const std::size_t end = text.find("</name>");
  if (begin == text.npos || end == text.npos || end < begin + open.size()) return "";
  const std::string name = text.substr(begin + open.size(), end - begin - open.size());
  const std::size_t first = name.find_first_not_of(" \t\r\n");
  const std::size_t last = name.find_last_not_of(" \t\r\n");
  return first == name.npos ? "" : name.substr(first, last - first + 1);
}

bool IsPackage(const fs::path& folder, const std::string& name) {
  const std::string own = NameInManifest(folder);
  if (!own.empty()) return own == name;
  return folder.filename() == name && IsFile(folder / "package.xml");
}

// In a workspace packages lie below folders of repositories.
std::optional<fs::path> SearchBelow(const fs::path& top, const std::string& name) {
  std::error_code error;
  fs::recursive_directory_iterator each(top, fs::directory_options::skip_permission_denied, error);
  int folders = 0;
  for (const fs::recursive_directory_iterator end; !error && each != end; each.increment(error)) {
    std::error_code ignored;
    if (!each->is_directory(ignored)) continue;
    if (++folders > kMaxFolders) break;
    const fs::path& folder = each->path();
    const std::string leaf = folder.filename().string();
    if (IsPackage(folder, name)) return folder;
    const bool is_closed = leaf.empty() || leaf[0] == '.' || IsFile(folder / "CATKIN_IGNORE") ||
                           IsFile(folder / "package.xml") || each.depth() + 1 >= kMaxDepth;
    if (is_closed) each.disable_recursion_pending();
  }
  return std::nullopt;
}

std::optional<fs::path> FindPackage(const std::string& name, const MeshSearch& search) {
  std::error_code ignored;
  for (const fs::path& entry : search.package_path) {
    if (IsPackage(entry, name)) return entry;
    if (fs::is_directory(entry / name, ignored)) return entry / name;
  }
  for (const fs::path& entry : search.package_path) {
    if (auto found = SearchBelow(entry, name)) return found;
  }
  if (search.urdf_folder.empty()) return std::nullopt;
  for (fs::path folder = fs::absolute(search.urdf_folder, ignored);;
       folder = folder.parent_path()) {
    if (IsPackage(folder, name)) return folder;
    if (IsPackage(folder / name, name)) return folder / name;  // a neighbour
    if (folder == folder.parent_path()) return std::nullopt;
  }
}

std::string List(const std::vector<fs::path>& paths) {
  std::string list;
  for (const fs::path& path : paths) list += (list.empty() ? "" : ", ") + path.string();
  return list.empty() ? "an empty package path" : list;
}

std::variant<fs::path, MeshNotFound> Existing(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_regular_file(status)) return path;
  if (error || !fs::exists(status)) {
    return MeshNotFound{path.string() + ": " +
                        (error ? error.message() : std::string("No such file or directory"))};
  }
  return MeshNotFound{path.string() + ": not a regular file"};
}

}  // namespace

MeshSearch MakeMeshSearch(const fs::path& urdf_file, const std::vector<std::string>& package_path) {
  MeshSearch search;
  std::error_code ignored;
  search.urdf_folder = fs::absolute(urdf_file, ignored).parent_path();
  for (const std::string& entry : package_path) {
    search.package_path.push_back(fs::absolute(entry, ignored));
  }
  const char* from_ros = std::getenv("ROS_PACKAGE_PATH");
  std::istringstream entries(from_ros != nullptr ? from_ros : "");
  for (std::string entry; std::getline(entries, entry, ':');) {
    if (!entry.empty()) search.package_path.push_back(entry);
  }
  return search;
}

std::variant<fs::path, MeshNotFound> FindMesh(const std::string& uri, const MeshSearch& search) {
  std::string_view rest = uri;
  if (uri.find('\0') != uri.npos) return MeshNotFound{"its name contains a zero byte"};
  if (TakePrefix(rest, "file://")) {
    if (rest.empty() || rest[0] != '/') {
      return MeshNotFound{uri + ": file:// needs an absolute path, such as file:///folder/name"};
    }
    return Existing(PercentDecoded(rest));
  }
  if (TakePrefix(rest, "package://")) {
    const std::size_t slash = rest.find('/');
    const std::string name(rest.substr(0, slash));
    if (name.empty() || name[0] == '.' || slash == rest.npos) {
      return MeshNotFound{uri + ": expected package://NAME/PATH"};
    }
    const auto folder = FindPackage(name, search);
    if (folder) return Existing(*folder / PercentDecoded(rest.substr(slash + 1)));
    return MeshNotFound{"package '" + name + "' was not found in " + List(search.package_path) +
                        " or around the URDF; add its folder to ROS_PACKAGE_PATH"};
  }
  if (const auto loaded = search.loaded.find(uri); loaded != search.loaded.end()) {
    return loaded->second;
  }
  if (uri.find("://") != uri.npos) {
    const bool is_on_web = uri.compare(0, 7, "http://") == 0 || uri.compare(0, 8, "https://") == 0;
    return MeshNotFound{
        uri + (is_on_web ? ": meshes on web servers are loaded for robots only" : ": unsupported") +
        "; expected package://, file:// or a path"};
  }
  const fs::path path = uri;
  if (path.is_absolute()) return Existing(path);
  if (path.empty()) return MeshNotFound{"it has no file name"};
  if (search.urdf_folder.empty()) {
    return MeshNotFound{uri +
                        ": a relative path, but the URDF was not read from a file; use package://, "
                        "file:// or an absolute path"};
  }
  return Existing(search.urdf_folder / path);
}

}  // namespace kinescope::urdf
