// Preloaded into WeasyPrint, it makes rare timing certain: the threads with which Pango sorts fonts
// do not begin before Pango has been unloaded. If it never is, they do not begin.
#include <dlfcn.h>
#include <semaphore.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <ctime>
#include <string_view>

namespace {

using Work = void* (*)(void*);

constexpr char kPango[] = "libpangoft2-1.0.so.0";
constexpr int kPatienceSecs = 5;  // only if something waits for the fonts after all

std::atomic<bool> pango_was_loaded = false;
std::atomic<int> late_threads = 0;

struct Late {
  Work work;
  void* of;
};

sem_t* Unloaded() {
  static sem_t semaphore = [] {
    sem_t made;
    ::sem_init(&made, 0, 0);
    return made;
  }();
  return &semaphore;
}

void* BeginLate(void* data) {
  const Late late = *static_cast<Late*>(data);
  delete static_cast<Late*>(data);
  timespec until{};
  ::clock_gettime(CLOCK_REALTIME, &until);
  until.tv_sec += kPatienceSecs;
  ::sem_timedwait(Unloaded(), &until);
  return late.work(late.of);
}

bool IsPangoLoaded() {
  void* pango = ::dlopen(kPango, RTLD_LAZY | RTLD_NOLOAD);
  if (pango == nullptr) return false;
  static const auto close = reinterpret_cast<int (*)(void*)>(::dlsym(RTLD_NEXT, "dlclose"));
  close(pango);
  return true;
}

}  // namespace

// Of GLib, which WeasyPrint loads for itself alone, so not among what comes next.
extern "C" void* g_thread_new(const char* name, Work work, void* of) {
  using Make = void* (*)(const char*, Work, void*);
  static const auto real =
      reinterpret_cast<Make>(::dlsym(::dlopen("libglib-2.0.so.0", RTLD_LAZY), "g_thread_new"));
  if (real == nullptr) std::abort();
  if (std::string_view(name).find("FcFontSetSort") == std::string_view::npos) {
    return real(name, work, of);
  }
  pango_was_loaded = true;
  ++late_threads;
  return real(name, BeginLate, new Late{work, of});
}

extern "C" int dlclose(void* library) noexcept {
  static const auto real = reinterpret_cast<int (*)(void*)>(::dlsym(RTLD_NEXT, "dlclose"));
  const int result = real(library);
  if (!pango_was_loaded || IsPangoLoaded()) return result;
  for (int i = 0; i < late_threads; ++i) ::sem_post(Unloaded());
  ::pause();  // the threads begin, and end the process
  return result;
}
