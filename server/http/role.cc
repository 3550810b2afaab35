#include "server/http/role.h"

namespace kinescope::http {

std::string WhyNotPermitted(std::string_view what, Role role) {
  return std::string(what) + ": a " + std::string(Name(role)) +
         " may look but not change anything; use the operator's token (--token_file)";
}

}  // namespace kinescope::http
