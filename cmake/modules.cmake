# All that is loaded at run time: what a test or a benchmark depends on that draws or writes clips.
add_custom_target(kinescope_modules ALL)

# A program may look for a module while it is being linked, so it appears whole.
string(REPLACE "-o <TARGET>" "-o <TARGET>.new" KINESCOPE_LINK_MODULE "${CMAKE_CXX_CREATE_SHARED_LIBRARY}")
set(KINESCOPE_LINK_MODULE "${KINESCOPE_LINK_MODULE}" "<CMAKE_COMMAND> -E rename <TARGET>.new <TARGET>")
set(CMAKE_CXX_CREATE_SHARED_MODULE "${KINESCOPE_LINK_MODULE}")

# kinescope_module(<name> EXPORTS <map> SOURCES <file>... LIBS <target>...): loaded at run time,
# shows the symbols of its map and no other.
function(kinescope_module name)
  cmake_parse_arguments(ARG "" "EXPORTS" "SOURCES;LIBS" ${ARGN})
  add_library(${name} MODULE ${ARG_SOURCES})
  set_target_properties(${name} PROPERTIES
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib/kinescope
    LINK_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${ARG_EXPORTS})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE ${ARG_LIBS} kinescope::strict)
  target_link_options(${name} PRIVATE
    "LINKER:--version-script=${CMAKE_CURRENT_SOURCE_DIR}/${ARG_EXPORTS}" LINKER:--as-needed)
  add_dependencies(kinescope_modules ${name})
  install(TARGETS ${name} LIBRARY DESTINATION lib/kinescope COMPONENT modules)
endfunction()
