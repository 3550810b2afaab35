/// A GL 3.2 core context in memory, without display, window system or GPU. Belongs to one thread.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace kinescope::render {

class OsmesaContext {
 public:
  /// @throws RenderError saying which Mesa would do.
  OsmesaContext();
  ~OsmesaContext();
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  /// To be called before any GL command: another renderer on this thread may have been drawing.
  void MakeCurrent();

  /// GL_RENDERER.
  std::string renderer_string() const { return renderer_string_; }

 private:
  void* context_ = nullptr;
  // The context's own framebuffer. Nothing is drawn there: VTK draws into framebuffer objects.
  std::array<std::uint8_t, 4 * 16 * 16> unused_pixels_{};
  std::string renderer_string_;
};

}  // namespace kinescope::render
