/// Requests and answers as the router uses them. Plain values without types of the HTTP library.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/http/snapshot_request.h"

namespace kinescope::http {

struct Request {
  std::string method;  // "GET"
  std::string target;  // not decoded
  std::string host;
  std::string origin;
  std::string cookies;
  std::string if_none_match;
  std::string content_type;
  std::optional<std::string> body;  // nullopt: not read yet
  std::string authorization;
  std::string accept;
  std::string sec_fetch_site;
  std::string page_header;       // X-Kinescope-Page, which only our page and other programs can set
  std::string socket_protocols;  // Sec-WebSocket-Protocol: what the client can read, or ""
  std::string address;           // of the client, without port; behind a proxy, as that says
  bool is_encrypted = false;     // between the client and a proxy that is believed
  std::chrono::steady_clock::time_point received_at{};
};

struct Answer {
  int status = 200;
  std::string content_type = "application/json";
  std::string body;
  std::optional<std::filesystem::path> file;  // sent in place of `body`
  std::optional<SnapshotRequest> snapshot;    // rendered first, then sent in place of `body`
  std::vector<std::pair<std::string, std::string>> headers;
  bool to_token_holder = false;  // the request contained the token
  bool needs_body = false;       // nothing is sent: the request is routed again with its body
};

/// The reason if a former state is requested where there is none.
inline constexpr char kNoHistory[] =
    "this server keeps no former states (--history_minutes=0), or none came yet";
/// The reason if marks are requested where none can be set.
inline constexpr char kNoMarks[] =
    "nothing can be marked on this server: it keeps no former states (--history_minutes=0)";
/// The reason if a picture or its camera is requested from a server without a renderer.
inline constexpr char kNoRenderer[] = "this server renders no pictures (--pictures=off)";

/// JSON that no cache keeps.
[[nodiscard]] Answer JsonAnswer(std::string body);

/// Routes the request again with its body, which has not been read.
[[nodiscard]] Answer AskForBody();

/// {"error": reason}: the form of every error under /api.
[[nodiscard]] Answer ErrorAnswer(int status, const std::string& reason);

}  // namespace kinescope::http
