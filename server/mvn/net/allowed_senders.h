/// Which machines may send to a receiver. A plain value, any thread.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "server/mvn/endpoint.h"

namespace kinescope::mvn {

class AllowedSenders {
 public:
  AllowedSenders() = default;  // all
  /// `text`: addresses and networks with commas in between, "192.168.1.20,10.0.0.0/8,fe80::/10".
  /// @throws std::invalid_argument with the wrong part and what was expected
  explicit AllowedSenders(std::string_view text);

  bool Allow(const Endpoint& sender) const;
  bool are_all() const { return networks_.empty(); }

 private:
  struct Network {
    std::array<std::uint8_t, 16> address{};  // as in Endpoint
    int bits = 128;                          // of the address that count
  };
  static Network Parse(const std::string& text);

  std::vector<Network> networks_;
};

/// Logs that the receiver `description` rejects `sender`. Call it for the first stranger.
void WarnOfStranger(const std::string& description, const Endpoint& sender);

}  // namespace kinescope::mvn
