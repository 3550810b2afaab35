/// Requests and answers as the router uses them. Plain values without types of the HTTP library.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/picture_limits.h"

namespace kinescope::http {

struct Request {
  std::string method;  // "GET"
  std::string target;  // not decoded
  std::string host;
  std::string origin;
  std::string cookies;
  std::string if_none_match;
  std::string content_type;
  std::string body;
};

struct SnapshotRequest {
  std::string camera;                  // "": that of the live picture
  int width = kDefaultPictureWidth;    // px
  int height = kDefaultPictureHeight;  // px
};

struct Answer {
  int status = 200;
  std::string content_type = "application/json";
  std::string body;
  std::optional<std::filesystem::path> file;  // sent in place of `body`
  std::optional<SnapshotRequest> snapshot;    // rendered first, then sent in place of `body`
  std::vector<std::pair<std::string, std::string>> headers;
};

/// {"error": reason}: the form of every error under /api and /snapshot.png.
[[nodiscard]] Answer ErrorAnswer(int status, const std::string& reason);

}  // namespace kinescope::http
