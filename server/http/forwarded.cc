#include "server/http/forwarded.h"

#include <algorithm>
#include <boost/asio/ip/address_v6.hpp>

#include "server/http/client_address.h"

namespace kinescope::http {
namespace {

namespace ip = boost::asio::ip;

std::string_view Trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// "192.0.2.1", "192.0.2.1:4711", "2001:db8::1", "[2001:db8::1]:4711"; some proxies add the port.
ip::address ParseAddress(std::string_view text, boost::system::error_code& error) {
  if (!text.empty() && text.front() == '[') {
    text = text.substr(1, std::min(text.find(']'), text.size()) - 1);
  } else if (std::count(text.begin(), text.end(), ':') == 1) {
    text = text.substr(0, text.find(':'));
  }
  return ip::make_address(std::string(text), error);
}

}  // namespace

bool Believes(const IpNetworks& proxies, const ip::address& peer) {
  const ip::address_v6 wide =
      peer.is_v4() ? ip::make_address_v6(ip::v4_mapped, peer.to_v4()) : peer.to_v6();
  return proxies.Has(wide.to_bytes());
}

std::string ClientBehind(const IpNetworks& proxies, const ip::address& peer,
                         std::string_view forwarded_for) {
  ip::address client = peer;
  while (!forwarded_for.empty() && Believes(proxies, client)) {
    const std::size_t comma = forwarded_for.rfind(',');
    const bool is_first = comma == std::string_view::npos;
    boost::system::error_code error;
    const ip::address before =
        ParseAddress(Trimmed(forwarded_for.substr(is_first ? 0 : comma + 1)), error);
    if (error) break;
    client = before;
    forwarded_for = is_first ? "" : forwarded_for.substr(0, comma);
  }
  return ClientAddress(client);
}

}  // namespace kinescope::http
