#include "core/system/web_address.h"

#include <cstddef>

#include "core/system/starts_with.h"

namespace kinescope {

bool IsWebAddress(const std::string& address) {
  return StartsWith(address, "http://") || StartsWith(address, "https://");
}

std::string ServerOf(const std::string& address) {
  const std::size_t scheme = address.find("://");
  const std::size_t begin = scheme == std::string::npos ? 0 : scheme + 3;
  std::string place = address.substr(begin, address.find_first_of("/?#", begin) - begin);
  const std::size_t user = place.rfind('@');  // name and password before it
  if (user != std::string::npos) place.erase(0, user + 1);
  return address.substr(0, begin) + place;
}

}  // namespace kinescope
