/// What a client may do: a viewer looks, an operator also changes what all clients see. Pure
/// functions, any thread.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace kinescope::http {

/// In rising order: each role may do all that the ones before it may.
enum class Role : std::uint8_t {
  kViewer,    // states, pictures, former moments: nothing that another client could notice
  kOperator,  // changes too: hand loads, the camera of the live picture
};

/// "viewer", "operator".
[[nodiscard]] constexpr std::string_view Name(Role role) {
  return role == Role::kOperator ? "operator" : "viewer";
}

[[nodiscard]] constexpr bool MayAct(Role role, Role least) { return role >= least; }

/// Why `what` (a route or a command, as the client typed it) is refused to `role`, with the way
/// out; one line.
[[nodiscard]] std::string WhyNotPermitted(std::string_view what, Role role);

}  // namespace kinescope::http
