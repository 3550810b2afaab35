/// The beginning of a response of HTTP: status line and headers. Pure function, any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "server/http/answer.h"

namespace kinescope::http {

/// What the connection adds to an answer.
struct ResponseFraming {
  unsigned version = 11;                        // of the request: 10 is HTTP/1.0
  std::optional<std::uint64_t> content_length;  // nullopt: not told, there is no content
  bool keep_alive = false;                      // the connection serves further requests
};

/// With the empty line at its end. A header of `answer` takes the place of the usual one.
[[nodiscard]] std::string ResponseHead(const Answer& answer, const ResponseFraming& framing);

}  // namespace kinescope::http
