// Any text as a file of camera keys: a reason, or keys whose times ascend and whose places are
// finite.
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/system/check.h"
#include "core/system/errors.h"
#include "server/picture/camera_keys.h"

namespace camera_keys_fuzz {

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinescope;
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    double before = -1;
    for (const app::CameraKeySpec& key : app::ParseCameraKeys("keys.yaml", text)) {
      KINESCOPE_CHECK(key.secs > before);
      KINESCOPE_CHECK(key.place.position.allFinite() && key.place.target.allFinite());
      before = key.secs;
    }
    KINESCOPE_CHECK(before >= 0);
  } catch (const UsageError& error) {
    KINESCOPE_CHECK(std::string(error.what()).rfind("--camera=keys.yaml: ", 0) == 0);
  }
  return 0;
}

}  // namespace camera_keys_fuzz
