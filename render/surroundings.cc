#include "render/surroundings.h"

namespace kinescope::render {

std::unique_ptr<SurroundingsWriter> MakeSurroundingsWriter() {
  static const SurroundingsModule& module =
      OpenModule<SurroundingsModule>("libkinescope_surroundings.so", kSurroundingsEntry);
  return module.make();
}

}  // namespace kinescope::render
