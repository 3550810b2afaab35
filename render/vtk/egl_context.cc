#include "render/vtk/egl_context.h"

#include <GL/glew.h>
// GLEW has taken the name away that EGL's headers declare their functions with.
#define GLAPI extern
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <string>
#include <vector>

#include "render/renderer.h"
#include "render/vtk/log_window.h"

// GLEW would ask GLX, and that an X display (osmesa_context.cc says how these come first).
extern "C" {

using AnyFunction = void (*)();

__attribute__((visibility("default"))) AnyFunction glXGetProcAddressARB(const unsigned char* name) {
  return eglGetProcAddress(reinterpret_cast<const char*>(name));
}

__attribute__((visibility("default"))) GLenum glxewInit() { return GLEW_OK; }

}  // extern "C"

namespace kinescope::render {
namespace {

std::string ErrorName(EGLint error) {
  switch (error) {
    case EGL_SUCCESS: return "no error";
    case EGL_NOT_INITIALIZED: return "EGL_NOT_INITIALIZED";
    case EGL_BAD_ACCESS: return "EGL_BAD_ACCESS";
    case EGL_BAD_ALLOC: return "EGL_BAD_ALLOC";
    case EGL_BAD_ATTRIBUTE: return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONFIG: return "EGL_BAD_CONFIG";
    case EGL_BAD_CONTEXT: return "EGL_BAD_CONTEXT";
    case EGL_BAD_DISPLAY: return "EGL_BAD_DISPLAY";
    case EGL_BAD_MATCH: return "EGL_BAD_MATCH";
    case EGL_BAD_PARAMETER: return "EGL_BAD_PARAMETER";
    default: return "EGL error " + std::to_string(error);
  }
}

bool Has(const char* extensions, const std::string& wanted) {
  if (extensions == nullptr) return false;
  return (" " + std::string(extensions) + " ").find(" " + wanted + " ") != std::string::npos;
}

template <class Function>
Function GlProcedure(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

void EGLAPIENTRY OnMessage(EGLenum /*error*/, const char* command, EGLint /*type*/,
                           EGLLabelKHR /*thread*/, EGLLabelKHR /*object*/, const char* message) {
  const std::string what = message != nullptr ? message : "";
  LogHere("egl: " + std::string(command != nullptr ? command : "") + ": " + what);
}

// Errors and warnings of EGL itself, which Mesa otherwise writes to stderr.
void RouteMessages(const char* client_extensions) {
  if (!Has(client_extensions, "EGL_KHR_debug")) return;
  const auto control = GlProcedure<PFNEGLDEBUGMESSAGECONTROLKHRPROC>("eglDebugMessageControlKHR");
  const EGLAttrib wanted[] = {EGL_DEBUG_MSG_WARN_KHR, EGL_TRUE, EGL_NONE};
  if (control != nullptr) control(&OnMessage, wanted);
}

EGLDisplay SurfacelessDisplay() {
  return eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
}

// Of GPUs; Mesa lists its own software among the devices.
std::vector<EGLDisplay> DeviceDisplays(const char* client_extensions) {
  if (!Has(client_extensions, "EGL_EXT_platform_device")) {
    throw RenderError(
        "--backend=egl_device: EGL lists no devices (EGL_EXT_platform_device is missing); install "
        "the driver of the GPU with EGL, or use --backend=osmesa");
  }
  const auto query = GlProcedure<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  const auto text_of = GlProcedure<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  std::array<EGLDeviceEXT, 32> devices{};
  EGLint count = 0;
  if (query == nullptr || text_of == nullptr ||
      query(static_cast<EGLint>(devices.size()), devices.data(), &count) == EGL_FALSE) {
    count = 0;
  }
  std::vector<EGLDisplay> displays;
  for (EGLint i = 0; i < count; ++i) {
    EGLDeviceEXT device = devices[static_cast<std::size_t>(i)];
    if (Has(text_of(device, EGL_EXTENSIONS), "EGL_MESA_device_software")) continue;
    displays.push_back(eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, device, nullptr));
  }
  if (displays.empty()) {
    throw RenderError("--backend=egl_device: EGL found no GPU (devices: " + std::to_string(count) +
                      ", all software); install the driver, check the permissions of "
                      "/dev/dri/renderD*, or use --backend=osmesa");
  }
  return displays;
}

// EGL_NO_CONTEXT and why, when `display` gives none.
EGLContext CreateContext(EGLDisplay display, std::string& why) {
  const auto fail = [&](const char* what) {
    why = std::string(what) + ": " + ErrorName(eglGetError());
    return EGL_NO_CONTEXT;
  };
  if (display == EGL_NO_DISPLAY) return fail("eglGetPlatformDisplay");
  if (eglInitialize(display, nullptr, nullptr) == EGL_FALSE) return fail("eglInitialize");
  if (!Has(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context")) {
    why = "EGL_KHR_surfaceless_context is missing";
    return EGL_NO_CONTEXT;
  }
  eglBindAPI(EGL_OPENGL_API);
  const EGLint config_wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                  EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(display, config_wanted, &config, 1, &count) == EGL_FALSE || count == 0) {
    return fail("eglChooseConfig");
  }
  const EGLint context_wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                                   3,
                                   EGL_CONTEXT_MINOR_VERSION,
                                   2,
                                   EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                   EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                   EGL_NONE};
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, context_wanted);
  return context != EGL_NO_CONTEXT ? context : fail("eglCreateContext (OpenGL 3.2 core)");
}

}  // namespace

EglContext::EglContext(const std::string& backend) {
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  RouteMessages(extensions);
  const bool is_device = backend == "egl_device";
  std::string tried;
  for (EGLDisplay display :
       is_device ? DeviceDisplays(extensions) : std::vector<EGLDisplay>{SurfacelessDisplay()}) {
    std::string why;
    context_ = CreateContext(display, why);
    display_ = display;
    if (context_ != EGL_NO_CONTEXT) break;
    tried += (tried.empty() ? "" : "; ") + why;
  }
  if (context_ == nullptr) {
    throw RenderError(
        is_device
            ? "--backend=egl_device: no GPU provides an OpenGL context through EGL (" + tried +
                  "); check the permissions of /dev/dri/renderD*, install a driver with OpenGL "
                  "3.2, or use --backend=osmesa"
            : "--backend=egl: EGL provides no surfaceless OpenGL context (" + tried +
                  "); install Mesa's EGL with llvmpipe (Debian: libegl-mesa0, libgl1-mesa-dri), or "
                  "use --backend=osmesa");
  }
  MakeCurrent();
}

EglContext::~EglContext() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
}

void EglContext::MakeCurrent() {
  if (eglGetCurrentContext() == context_) return;
  eglBindAPI(EGL_OPENGL_API);  // of this thread
  if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE) {
    throw RenderError("EGL cannot make its context current: " + ErrorName(eglGetError()));
  }
}

std::unique_ptr<GlContext> MakeGlContext(const std::string& backend) {
  return std::make_unique<EglContext>(backend);
}

}  // namespace kinescope::render
