// Any bytes as the GLB of a rigged person: refused with a reason, or a skin that can be drawn.
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/system/check.h"
#include "urdf/rig/rig.h"
#include "urdf/rig/rigged_skin.h"
#include "urdf/skin/frames.h"

namespace rig_fuzz {

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinescope;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const skin::SkinTemplate skin = rig::SkinOf(rig::ReadRig(bytes));
    KINESCOPE_CHECK(!skin.triangles.empty() && skin.triangles.size() <= rig::kMaxTriangles);
    KINESCOPE_CHECK(skin.size() <= rig::kMaxVertices && skin.colors.size() == skin.size());
    KINESCOPE_CHECK(skin.corners[0].size() == skin.size());
    for (const skin::Triangle& triangle : skin.triangles) {
      for (const std::uint16_t corner : triangle) KINESCOPE_CHECK(corner < skin.size());
    }
    for (std::size_t i = 0; i < skin.size(); ++i) {
      KINESCOPE_CHECK(skin.corners[0][i].allFinite());
      int sum = 0;
      for (std::size_t k = 0; k < skin::kInfluences; ++k) {
        KINESCOPE_CHECK(skin.weights[i].frames[k] < skin::Frames().size());
        sum += skin.weights[i].weights[k];
      }
      KINESCOPE_CHECK(sum == 255);
    }
  } catch (const std::runtime_error& error) {
    KINESCOPE_CHECK(error.what()[0] != '\0');
  }
  return 0;
}

}  // namespace rig_fuzz
