/// What a proxy says of its client, and of whom that is believed. Pure functions, any thread.
#pragma once

#include <boost/asio/ip/address.hpp>
#include <string>
#include <string_view>

#include "core/system/ip_networks.h"

namespace kinescope::http {

/// Whether the headers of `peer` are believed.
[[nodiscard]] bool Believes(const IpNetworks& proxies, const boost::asio::ip::address& peer);

/// The address of the client behind `peer`, as ClientAddress() writes it. `forwarded_for`:
/// X-Forwarded-For, to which each proxy adds the one that it has received from: so the last one
/// that is no proxy is the client, and what a client wrote itself, before that, is not believed.
[[nodiscard]] std::string ClientBehind(const IpNetworks& proxies,
                                       const boost::asio::ip::address& peer,
                                       std::string_view forwarded_for);

}  // namespace kinescope::http
