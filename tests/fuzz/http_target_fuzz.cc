// Any text as the target of an HTTP request: a reason, or a path that stays inside.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/system/check.h"
#include "server/http/target.h"

namespace http_target_fuzz {

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto target = kinescope::http::ParseTarget({reinterpret_cast<const char*>(data), size});
  if (!target) {
    KINESCOPE_CHECK(!target.error().empty());
    return 0;
  }
  const std::string_view path = target->path;
  KINESCOPE_CHECK(!path.empty() && path.front() == '/');
  KINESCOPE_CHECK(path.find('\0') == std::string_view::npos);
  return 0;
}

}  // namespace http_target_fuzz
