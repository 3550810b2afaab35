/// The address by which shares and limits tell clients apart. Pure functions, any thread.
#pragma once

#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <string>

namespace kinescope::http {

/// An IPv4 address is a client, also each one of 127.0.0.0/8 and if it comes over an IPv6 socket.
/// Of IPv6, a network of 64 bits is: a client with one address of it usually has all. ::1 is
/// itself.
[[nodiscard]] std::string ClientAddress(const boost::asio::ip::address& address);

/// Of the other end of `socket`; "unknown" after it was closed.
[[nodiscard]] std::string ClientAddress(const boost::asio::ip::tcp::socket& socket);

}  // namespace kinescope::http
