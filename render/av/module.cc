#include "render/module.h"

#include "render/av/h264_writer.h"

extern "C" __attribute__((visibility("default"))) const void* KinescopeVideoModule() {
  static const kinescope::render::VideoModule module = {{}, &kinescope::render::av::MakeH264Writer};
  return &module;
}
