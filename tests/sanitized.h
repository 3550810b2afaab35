/// Whether the tests are compiled with the address or thread sanitizer: code is then many times
/// slower and has another heap.
#pragma once

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define KINESCOPE_SANITIZED 1  // GCC
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define KINESCOPE_SANITIZED 1  // clang
#endif
#endif

namespace kinescope::testing {

#ifdef KINESCOPE_SANITIZED
inline constexpr bool kIsSanitized = true;
#else
inline constexpr bool kIsSanitized = false;
#endif

}  // namespace kinescope::testing
