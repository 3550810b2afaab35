// Preloaded into the program under test: OpenGL whose read-back hangs while the file
// $HANGING_DRIVER_FILE exists and has nothing in it, and crashes when it has something in it.
#include <dlfcn.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <initializer_list>

namespace {

using ReadPixels = void (*)(int, int, int, int, unsigned, unsigned, void*);

// Loaded by the drawing module for itself alone, so not among what comes next.
ReadPixels FindReal() {
  for (const char* library : {"libOSMesa.so.8", "libOpenGL.so.0"}) {
    void* gl = ::dlopen(library, RTLD_LAZY | RTLD_NOLOAD);
    if (gl == nullptr) continue;
    if (void* found = ::dlsym(gl, "glReadPixels")) return reinterpret_cast<ReadPixels>(found);
  }
  std::abort();
}

}  // namespace

extern "C" void glReadPixels(int x, int y, int width, int height, unsigned format, unsigned type,
                             void* pixels) {
  static const ReadPixels real = FindReal();
  const char* path = std::getenv("HANGING_DRIVER_FILE");
  struct stat file {};
  while (path != nullptr && ::stat(path, &file) == 0) {
    if (file.st_size > 0) std::abort();
    ::usleep(1000);
  }
  real(x, y, width, height, format, type, pixels);
}
