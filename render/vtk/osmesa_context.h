/// A GL context in memory, drawn by Mesa's llvmpipe, without display, window system or GPU.
#pragma once

#include <array>
#include <cstdint>

#include "render/vtk/gl_context.h"

namespace kinescope::render {

class OsmesaContext : public GlContext {
 public:
  /// @throws RenderError saying which Mesa would do.
  OsmesaContext();
  ~OsmesaContext() override;
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  void MakeCurrent() override;

 private:
  void* context_ = nullptr;
  // The context's own framebuffer. Nothing is drawn there: VTK draws into framebuffer objects.
  std::array<std::uint8_t, 4 * 16 * 16> unused_pixels_{};
};

}  // namespace kinescope::render
