/// Makes a GL context in memory, rendered by Mesa's llvmpipe, without display, window system or
/// GPU.
#pragma once

#include <array>
#include <cstdint>

#include "render/vtk/gl_context.h"

namespace kinescope::render {

class OsmesaContext : public GlContext {
 public:
  /// @throws RenderError with the Mesa that is required.
  OsmesaContext();
  ~OsmesaContext() override;
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  void MakeCurrent() override;

 private:
  void* context_ = nullptr;
  // The context's own framebuffer. It stays unused: VTK renders into framebuffer objects.
  std::array<std::uint8_t, 4 * 16 * 16> unused_pixels_{};
};

}  // namespace kinescope::render
