# kinescope::strict: what every target of ours is compiled with. PRIVATE-ly linked.
set(CMAKE_CXX_STANDARD 17)  # ROS 1 messages do not compile as C++20 on Debian 12
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
# The presets compile mostly the same; ccache does it once.
find_program(KINESCOPE_CCACHE ccache)
if(KINESCOPE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${KINESCOPE_CCACHE})
endif()
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE RelWithDebInfo CACHE STRING "" FORCE)
endif()

add_library(kinescope_strict INTERFACE)
add_library(kinescope::strict ALIAS kinescope_strict)
target_compile_options(kinescope_strict INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Werror)

if(KINESCOPE_SANITIZE)
  # GCC 12 warns wrongly of what it instruments itself, in std::regex for one.
  add_compile_options(-fsanitize=${KINESCOPE_SANITIZE} -fno-omit-frame-pointer
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  add_link_options(-fsanitize=${KINESCOPE_SANITIZE})
  if(KINESCOPE_SANITIZE MATCHES address)
    add_compile_options(-fsanitize=undefined -fno-sanitize-recover=undefined)
    add_link_options(-fsanitize=undefined)
  endif()
endif()
