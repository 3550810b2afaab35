#include "render/vtk/osmesa_context.h"

#include <GL/glew.h>
// GLEW has taken the name away that osmesa.h declares its functions with.
#define GLAPI extern
#include <GL/osmesa.h>

#include <cstdlib>
#include <string>

#include "render/renderer.h"

// Debian's VTK finds GL functions through the system's GLEW, and that asks GLX, which needs an X
// display. These two take the place of GLX's for everything inside this module: it is loaded with
// RTLD_LOCAL, and its own symbols come before those of the libraries it depends on.
extern "C" {

using AnyFunction = void (*)();

__attribute__((visibility("default"))) AnyFunction glXGetProcAddressARB(const unsigned char* name) {
  return reinterpret_cast<AnyFunction>(OSMesaGetProcAddress(reinterpret_cast<const char*>(name)));
}

// GLEW's last step, which opens the display. All GL functions are found by then.
__attribute__((visibility("default"))) GLenum glxewInit() { return GLEW_OK; }

}  // extern "C"

namespace kinescope::render {

namespace {

// Mesa looks for the driver of that name and, finding none, uses it all the same: a crash.
void CheckDriverChoice() {
  const char* driver = std::getenv("GALLIUM_DRIVER");
  if (driver == nullptr || *driver == '\0') return;
  const std::string name = driver;
  if (name == "llvmpipe" || name == "softpipe") return;
  throw RenderError(
      "GALLIUM_DRIVER=" + name +
      ": expected llvmpipe or softpipe, the drivers of OSMesa; unset it or choose one of them");
}

}  // namespace

OsmesaContext::OsmesaContext() {
  CheckDriverChoice();
  const int wanted[] = {OSMESA_FORMAT,
                        OSMESA_RGBA,
                        OSMESA_DEPTH_BITS,
                        0,
                        OSMESA_STENCIL_BITS,
                        0,
                        OSMESA_PROFILE,
                        OSMESA_CORE_PROFILE,
                        OSMESA_CONTEXT_MAJOR_VERSION,
                        3,
                        OSMESA_CONTEXT_MINOR_VERSION,
                        2,
                        0};
  context_ = OSMesaCreateContextAttribs(wanted, nullptr);
  if (context_ == nullptr) {
    throw RenderError(
        "--backend=osmesa: OSMesa provides no OpenGL 3.2 core context; install Mesa 12 to 25.0 "
        "with llvmpipe (Debian: libosmesa6), and unset GALLIUM_DRIVER");
  }
  MakeCurrent();
}

OsmesaContext::~OsmesaContext() {
  // A context that is gone must not stay current: the next one may come to lie at its address.
  OSMesaMakeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0);
  OSMesaDestroyContext(static_cast<OSMesaContext>(context_));
}

void OsmesaContext::MakeCurrent() {
  auto* context = static_cast<OSMesaContext>(context_);
  if (OSMesaGetCurrentContext() == context) return;
  if (OSMesaMakeCurrent(context, unused_pixels_.data(), GL_UNSIGNED_BYTE, 16, 16) == GL_FALSE) {
    throw RenderError("OSMesa cannot make its context current");
  }
}

std::unique_ptr<GlContext> MakeGlContext(const std::string& /*backend: there is one*/) {
  return std::make_unique<OsmesaContext>();
}

}  // namespace kinescope::render
