# kinescope::strict: what every target of ours is compiled with. PRIVATE-ly linked.
set(CMAKE_CXX_STANDARD 17)  # ROS 1 messages do not compile as C++20 on Debian 12
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
# What has been compiled once on a machine is not compiled again there: neither after a change of branch nor in another clone,
# since what is compiled does not depend on the folder: no path of it in a definition, but for those of the few sources that
# say where it lies, and none in a batch (batches.cmake). A precompiled header would: clang keeps its path.
find_program(KINESCOPE_CCACHE ccache)
if(KINESCOPE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER
    ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
    GLIBC_TUNABLES=glibc.malloc.hugetlb=1  # clang takes its memory in large pages: 5 to 10 % less CPU time
    ${KINESCOPE_CCACHE})
endif()
set(KINESCOPE_COST_METER "" CACHE FILEPATH "tests/gate/cost.cc as a program; ./check measures with it what each unit and each test costs")
if(KINESCOPE_COST_METER)
  list(PREPEND CMAKE_CXX_COMPILER_LAUNCHER ${KINESCOPE_COST_METER} unit)
endif()
file(RELATIVE_PATH KINESCOPE_SOURCES_FROM_BUILD ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR})  # as ccache names them
add_compile_options(-ffile-prefix-map=${PROJECT_SOURCE_DIR}/= -ffile-prefix-map=${KINESCOPE_SOURCES_FROM_BUILD}/=)
# Sources of a target are compiled several at a time: reading the headers is most of their price. Off: one by one, as an editor's
# language server likes it.
option(CMAKE_UNITY_BUILD "Compile the sources of a target in batches" ON)
set(CMAKE_UNITY_BUILD_BATCH_SIZE 26)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE RelWithDebInfo CACHE STRING "" FORCE)
endif()

add_library(kinescope_strict INTERFACE)
add_library(kinescope::strict ALIAS kinescope_strict)
target_compile_options(kinescope_strict INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Werror
  # GCC 12 sees a name hidden by an enumerator of a scoped enumeration, which hides none.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-shadow>)

# Pictures have the same bytes on processors of all makes: Eigen's fast square root begins with an estimate that each make
# has of its own (RSQRTPS). tests/exact_arithmetic_test.py
target_compile_definitions(kinescope_strict INTERFACE EIGEN_FAST_MATH=0)

if(CMAKE_UNITY_BUILD)
  # In a batch GCC takes a source for a header, whose types nobody may hide in an anonymous namespace.
  target_compile_options(kinescope_strict INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()

if(KINESCOPE_SANITIZE)
  # GCC 12 warns wrongly of what it instruments itself, in std::regex for one.
  add_compile_options(-fsanitize=${KINESCOPE_SANITIZE} -fno-omit-frame-pointer
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  add_link_options(-fsanitize=${KINESCOPE_SANITIZE})
  if(KINESCOPE_SANITIZE MATCHES address)
    add_link_options(-fsanitize=undefined)
  endif()
endif()

# kinescope_check_undefined([COMPUTES] <target>...): also with the sanitizer of undefined behaviour, and optimised, since tests run
# through it all day. That doubles the compile time, most where templates are many (Beast, CLI11, GoogleTest), so it is for what
# computes and what reads bytes of others. COMPUTES: no pointer is cast there, so nothing can be at an address that its type cannot
# have; the test of each address that Eigen takes is a quarter of the compile time.
function(kinescope_check_undefined)
  cmake_parse_arguments(ARG "COMPUTES" "" "" ${ARGN})
  foreach(target ${ARG_UNPARSED_ARGUMENTS})
    target_compile_options(${target} PRIVATE -O1 -fsanitize=undefined -fno-sanitize-recover=undefined
      # vptr: its run-time misjudges classes of GCC's standard library. The others: a third of the compile time, for what the
      # sanitizer of addresses finds when it is used.
      $<$<CXX_COMPILER_ID:Clang>:-fno-sanitize=vptr,null,object-size>
      $<$<BOOL:${ARG_COMPUTES}>:-fno-sanitize=alignment>)
    kinescope_link_first(${target})
  endforeach()
endfunction()

# kinescope_link_first(<library>): the linker reads it before the objects of a program. Of an inline function that several objects
# have, it takes the first, and a test's own is not optimised: Eigen's in the loops of a library, which then take twice as long.
function(kinescope_link_first target)
  target_link_options(${target} INTERFACE
    $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:LINKER:--whole-archive,$<TARGET_FILE:${target}>,--no-whole-archive>)
endfunction()
