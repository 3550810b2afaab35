// Preloaded into `golden stress`, it makes pictures depend on the time zone: digits are painted as
// others.
#include <dlfcn.h>

#include <cstdlib>
#include <string_view>

// Of FreeType, without its header: the types do not matter here.
extern "C" int FT_Load_Char(void* face, unsigned long code_point, int flags) {
  using Load = int (*)(void*, unsigned long, int);
  static const auto real = reinterpret_cast<Load>(::dlsym(RTLD_NEXT, "FT_Load_Char"));
  const char* const zone = std::getenv("TZ");
  const bool is_other = zone != nullptr && std::string_view(zone) == "Asia/Kathmandu";
  return real(face, is_other && code_point == '0' ? '8' : code_point, flags);
}
