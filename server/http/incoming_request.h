/// Requests as they come from the network: their limits, what can be wrong with their header, and
/// the values that the router gets. Pure functions, any thread.
#pragma once

#include <boost/beast/core/error.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/system/ip_networks.h"
#include "server/http/answer.h"
#include "server/http/forwarded.h"

namespace kinescope::http {

inline constexpr std::uint32_t kMaxHeaderBytes = 8192;
inline constexpr std::uint64_t kMaxBodyBytes = 4096;  // a hand load has 100
/// Of one connection. Beast's own limits do not count the extensions of chunks and the trailers.
inline constexpr std::size_t kMaxIncomingBytes = kMaxHeaderBytes + kMaxBodyBytes;

using IncomingRequest = boost::beast::http::request<boost::beast::http::string_body>;

/// Why a request is rejected before it is routed, and the status of the answer.
struct RequestDefect {
  int status = 0;
  std::string reason;
};

/// What is wrong with a complete header; nullopt: nothing.
[[nodiscard]] std::optional<RequestDefect> FindDefect(const IncomingRequest& header);

/// What was wrong with a request whose reading ended with `error`; of `header`, a part may have
/// been read. nullopt: the client has gone, and needs no answer.
[[nodiscard]] std::optional<RequestDefect> FindDefect(boost::beast::error_code error,
                                                      const IncomingRequest& header);

/// `header` without its body, as it came from `peer`. What a proxy says of its client is believed
/// if it is one of `proxies`.
[[nodiscard]] Request ToRequest(const IncomingRequest& header, const boost::asio::ip::address& peer,
                                const IpNetworks& proxies,
                                std::chrono::steady_clock::time_point now);

}  // namespace kinescope::http
