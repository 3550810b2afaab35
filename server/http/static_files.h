/// The files that the page consists of. The list is made once, at the start, from what lies in the
/// folder; a path that is not in it does not exist, so no path from outside ever reaches the file
/// system. Contents are read when asked for.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace kinescope::http {

struct StaticFile {
  std::filesystem::path path;  // canonical, below the folder
  std::string content_type;
};

class StaticFiles {
 public:
  /// Lists `web_root`: html, css, js, svg, png, ico and the libraries that the page imports (of
  /// node_modules nothing else). Hidden files and links that lead out of the folder are left out. A
  /// folder that is not there gives an empty list.
  explicit StaticFiles(const std::filesystem::path& web_root);

  /// The file of a decoded URL path such as "/app.js", "/" or "/lib/three/three.module.js"; null
  /// when there is none.
  const StaticFile* Find(const std::string& url_path) const;

  const std::map<std::string, StaticFile>& all() const { return files_; }

 private:
  std::map<std::string, StaticFile> files_;
};

/// The npm files that the page needs: URL below /lib/ and path below node_modules/.
struct Library {
  const char* url;
  const char* path;
};
const std::vector<Library>& Libraries();

/// Changes whenever the file does (time and size), quoted as HTTP wants it; "" when it is gone.
std::string EntityTag(const std::filesystem::path& path);

}  // namespace kinescope::http
