#include "server/http/without_tls.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "server/http/target.h"

namespace kinescope::http {
namespace {

// Nothing that could be more than a name, an address and a port.
bool IsPlainHost(std::string_view host) {
  return !host.empty() && std::all_of(host.begin(), host.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
           c == '.' || c == ':' || c == '[' || c == ']';
  });
}

}  // namespace

Answer AnswerWithoutTls(const Request& request) {
  const auto target = ParseTarget(request.target);
  const std::string host = IsPlainHost(request.host) ? request.host : "HOST:PORT";
  if (!target || (target->query.count("token") > 0) || !request.authorization.empty()) {
    return ErrorAnswer(400, "this port speaks TLS: open https://" + host +
                                "/. A token in this request was not encrypted: replace it if "
                                "others can read this network");
  }
  Answer answer = ErrorAnswer(308, "this port speaks TLS: open https://" + host + request.target);
  if (host == request.host) {
    answer.headers.emplace_back("Location", "https://" + host + request.target);
  } else {
    answer.status = 400;
  }
  return answer;
}

}  // namespace kinescope::http
