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
    add_link_options(-fsanitize=undefined)
  endif()
endif()

# kinescope_sanitize_fully(<target>...): optimised, since tests run through it all day, and with the
# sanitizer of undefined behaviour. That one costs a third of the compile time, most where templates are many
# (Beast, CLI11, GoogleTest), so it watches what computes and what reads bytes of others.
function(kinescope_sanitize_fully)
  foreach(target ${ARGN})
    target_compile_options(${target} PRIVATE -O1)
    if(KINESCOPE_SANITIZE MATCHES address)
      target_compile_options(${target} PRIVATE -fsanitize=undefined -fno-sanitize-recover=undefined)
    endif()
  endforeach()
endfunction()
