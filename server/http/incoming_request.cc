#include "server/http/incoming_request.h"

#include <boost/beast/core/string.hpp>
#include <boost/beast/http/error.hpp>
#include <iterator>

namespace kinescope::http {
namespace {

namespace beast = boost::beast;
namespace bhttp = boost::beast::http;

constexpr std::ptrdiff_t kMaxHeaderLines = 64;

template <class Name>  // bhttp::field or a string
std::string Header(const IncomingRequest& request, Name name) {
  const auto value = request[name];
  return {value.data(), value.size()};
}

// A header that may stand in several lines.
template <class Name>
std::string Joined(const IncomingRequest& request, Name name, const char* separator) {
  std::string all;
  const auto [first, last] = request.equal_range(name);
  for (auto line = first; line != last; ++line) {
    all.append(all.empty() ? "" : separator).append(line->value().data(), line->value().size());
  }
  return all;
}

// A body whose end we see elsewhere than a proxy does could hide a request.
std::optional<RequestDefect> FindFramingDefect(const IncomingRequest& request) {
  const std::size_t codings = request.count(bhttp::field::transfer_encoding);
  if (codings == 0) return std::nullopt;
  if (request.version() < 11) {
    return RequestDefect{400, "Transfer-Encoding in a request of HTTP/1.0; send Content-Length"};
  }
  if (codings == 1 && beast::iequals(request[bhttp::field::transfer_encoding], "chunked")) {
    return std::nullopt;
  }
  return RequestDefect{501, "unknown Transfer-Encoding; send Content-Length, or chunked alone"};
}

// What was wrong with the request `message`, of which the header may have been read.
std::string ReasonOf(beast::error_code error, const IncomingRequest& message) {
  if (error == bhttp::error::header_limit) {
    return "header of more than " + std::to_string(kMaxHeaderBytes) +
           " bytes; send fewer cookies or shorter headers";
  }
  if (error == bhttp::error::body_limit) {
    const std::string size = Header(message, bhttp::field::content_length);
    return "body of " + (size.empty() ? "too many" : size) + " bytes: at most " +
           std::to_string(kMaxBodyBytes) + " are accepted; send a smaller one";
  }
  if (error == bhttp::error::buffer_overflow) {
    return "chunk extensions or trailers of more than " + std::to_string(kMaxIncomingBytes) +
           " bytes; send the body without them";
  }
  return "invalid or unsupported HTTP request";
}

// 0: no answer, the connection is closed.
int StatusOf(beast::error_code error) {
  if (error == bhttp::error::header_limit) return 431;
  if (error == bhttp::error::body_limit || error == bhttp::error::buffer_overflow) return 413;
  if (error == bhttp::error::end_of_stream || error == bhttp::error::partial_message) return 0;
  return error.category() == make_error_code(bhttp::error::bad_value).category() ? 400 : 0;
}

}  // namespace

std::optional<RequestDefect> FindDefect(const IncomingRequest& header) {
  const auto lines = std::distance(header.begin(), header.end());
  if (lines > kMaxHeaderLines) {
    return RequestDefect{431, std::to_string(lines) + " lines in the header, expected at most " +
                                  std::to_string(kMaxHeaderLines) + "; send fewer headers"};
  }
  const std::size_t hosts = header.count(bhttp::field::host);
  if (hosts > 1) return RequestDefect{400, "several Host headers; send one"};
  if (hosts == 0 && header.version() >= 11) {
    return RequestDefect{400, "no Host header; HTTP/1.1 requires one"};
  }
  return FindFramingDefect(header);
}

std::optional<RequestDefect> FindDefect(beast::error_code error, const IncomingRequest& header) {
  const int status = StatusOf(error);
  if (status == 0) return std::nullopt;
  return RequestDefect{status, ReasonOf(error, header)};
}

Request ToRequest(const IncomingRequest& header, const boost::asio::ip::address& peer,
                  const IpNetworks& proxies, std::chrono::steady_clock::time_point now) {
  Request request;
  request.method = std::string(header.method_string());
  request.target = std::string(header.target());
  request.host = Header(header, bhttp::field::host);
  request.origin = Header(header, bhttp::field::origin);
  request.cookies = Joined(header, bhttp::field::cookie, "; ");
  request.if_none_match = Header(header, bhttp::field::if_none_match);
  request.content_type = Header(header, bhttp::field::content_type);
  request.authorization = Header(header, bhttp::field::authorization);
  request.accept = Header(header, bhttp::field::accept);
  request.sec_fetch_site = Header(header, "Sec-Fetch-Site");
  request.page_header = Header(header, "X-Kinescope-Page");
  request.is_encrypted = Believes(proxies, peer) && Header(header, "X-Forwarded-Proto") == "https";
  request.socket_protocols = Joined(header, bhttp::field::sec_websocket_protocol, ", ");
  request.address = ClientBehind(proxies, peer, Joined(header, "X-Forwarded-For", ","));
  request.received_at = now;
  return request;
}

}  // namespace kinescope::http
