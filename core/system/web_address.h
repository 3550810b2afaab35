/// Addresses of web servers and of what they have. Pure functions, any thread.
#pragma once

#include <string>

namespace kinescope {

[[nodiscard]] bool IsWebAddress(const std::string& address);  // http://, https://

/// Without path, user and password, which may be secrets: "http://robot:8000" of
/// "http://user:word@robot:8000/arm.stl?size=2".
[[nodiscard]] std::string ServerOf(const std::string& address);

}  // namespace kinescope
