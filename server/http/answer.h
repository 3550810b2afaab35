/// What the router decides and a connection sends. Plain values without any type of the HTTP
/// library.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kinescope::http {

struct Request {
  std::string method;  // "GET"
  std::string target;  // as it came
  std::string host;
  std::string origin;
  std::string cookies;
  std::string if_none_match;
  std::string content_type;
  std::string body;
};

struct SnapshotRequest {
  std::string camera;  // "": the live picture's
  int width = 1280;    // px
  int height = 720;    // px
};

struct Answer {
  int status = 200;
  std::string content_type = "application/json";
  std::string body;
  std::optional<std::filesystem::path> file;  // sent instead of `body`
  std::optional<SnapshotRequest> snapshot;    // drawn first, then sent instead of `body`
  std::vector<std::pair<std::string, std::string>> headers;
};

/// {"error": reason}, the shape of everything that goes wrong under /api and /snapshot.png.
[[nodiscard]] Answer ErrorAnswer(int status, const std::string& reason);

}  // namespace kinescope::http
