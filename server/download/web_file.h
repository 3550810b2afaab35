/// Loads a file from a web server.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace kinescope::download {

/// "arm.stl" of "http://robot:8000/arm.stl?size=2"; "" for one that ends with a slash.
[[nodiscard]] std::string FileNameOf(const std::string& address);

struct WebLimits {
  std::size_t most_bytes = std::size_t{64} << 20;
  double connect_secs = 3;
  double secs = 20;  // of a file, with the connection
};

/// Keeps connections from one file to the next. One thread.
class WebLoader {
 public:
  /// @param is_stopped  asked about once a second, and more often while bytes come: true ends the
  ///   loading; null: nothing does
  WebLoader(const WebLimits& limits, std::function<bool()> is_stopped);
  ~WebLoader();
  WebLoader(const WebLoader&) = delete;
  WebLoader& operator=(const WebLoader&) = delete;

  struct Outcome {
    std::string problem;        // "": all of the file is there
    bool is_of_server = false;  // the server does not answer at all, or too slowly
    std::size_t bytes = 0;
  };
  /// Into a new file, which does not stay if there is a problem. Follows at most five redirections.
  [[nodiscard]] Outcome Load(const std::string& address, const std::filesystem::path& into);

 private:
  struct Transfer;
  const WebLimits limits_;
  const std::function<bool()> is_stopped_;
  std::unique_ptr<Transfer> transfer_;
};

}  // namespace kinescope::download
