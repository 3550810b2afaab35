/// The answer to a client that sends HTTP to a port with TLS. Pure function, any thread.
#pragma once

#include "server/http/answer.h"

namespace kinescope::http {

/// Leads to the same address with https, unless the request has a token: then it is refused,
/// because the token was sent for all to read.
[[nodiscard]] Answer AnswerWithoutTls(const Request& request);

}  // namespace kinescope::http
