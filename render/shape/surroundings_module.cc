#include "render/shape/surroundings_glb.h"

extern "C" __attribute__((visibility("default"))) const void* KinescopeSurroundingsModule() {
  using namespace kinescope::render;
  static const SurroundingsModule module = {{}, []() -> std::unique_ptr<SurroundingsWriter> {
                                              return std::make_unique<SurroundingsGlb>();
                                            }};
  return &module;
}
