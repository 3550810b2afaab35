/// Finds the files of the web page. The list is made once at the start from the content of the
/// folder; a path that is not listed does not exist, so no path from a request reaches the file
/// system. File contents are read on request. Constant after construction, any thread.
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
  /// Lists `web_root`: html, css, js, svg, png, ico and the libraries that the page imports
  /// (nothing else of node_modules). Hidden files and links that leave the folder are omitted. A
  /// missing folder gives an empty list. `bundle`: a file with all modules of the page, which is
  /// "/app.js" unless it is missing or older than one of them; they are there beside it.
  explicit StaticFiles(const std::filesystem::path& web_root,
                       const std::filesystem::path& bundle = {});

  /// The file of a decoded URL path such as "/app.js", "/" or "/lib/three/three.module.js"; null if
  /// there is none.
  const StaticFile* Find(const std::string& url_path) const;

  const std::map<std::string, StaticFile>& all() const { return files_; }

 private:
  std::map<std::string, StaticFile> files_;
};

/// The npm files of the page: URL below /lib/ and path below node_modules/.
struct Library {
  const char* url;
  const char* path;
};
const std::vector<Library>& Libraries();

/// HTTP entity tag in quotes that changes with the file (time and size); "" if the file is missing.
std::string EntityTag(const std::filesystem::path& path);

}  // namespace kinescope::http
