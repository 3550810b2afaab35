/// What a proxy says of its client, and of whom that is believed. Pure functions, any thread.
#pragma once

#include <array>
#include <boost/asio/ip/address.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace kinescope::http {

/// Whether the headers of the machine with this address are believed. IPv6; IPv4 is mapped into it.
using IsProxy = std::function<bool(const std::array<std::uint8_t, 16>& address)>;

/// Null `is_proxy`: no machine is a proxy.
[[nodiscard]] bool Believes(const IsProxy& is_proxy, const boost::asio::ip::address& peer);

/// The address of the client behind `peer`, as ClientAddress() writes it. `forwarded_for`:
/// X-Forwarded-For, to which each proxy adds the one that it has received from: so the last one
/// that is no proxy is the client, and what a client wrote itself, before that, is not believed.
[[nodiscard]] std::string ClientBehind(const IsProxy& is_proxy,
                                       const boost::asio::ip::address& peer,
                                       std::string_view forwarded_for);

}  // namespace kinescope::http
