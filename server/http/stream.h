/// The TCP stream of one client. What a WebSocket receives is limited to so many bytes per second,
/// whatever these bytes are: then a flood of tiny frames costs little.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/basic_stream.hpp>
#include <boost/beast/core/rate_policy.hpp>

namespace kinescope::http {

using Stream = boost::beast::basic_stream<boost::asio::ip::tcp, boost::asio::any_io_executor,
                                          boost::beast::simple_rate_policy>;

}  // namespace kinescope::http
