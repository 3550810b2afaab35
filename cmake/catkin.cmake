# Makes this tree a catkin package too, in a catkin workspace and with plain CMake alike: catkin writes
# build/<preset>/devel/, whose setup.bash is all that roslaunch needs to find us.
#
# kinescope_expose_to_ros(<target> [DEVEL_ONLY])
#   Installs an executable, and lets ROS find it as <node pkg="kinescope" type="<target>">, from the
#   devel space and from an install tree. (rosrun finds it too, but looks into no build folder that lies
#   inside the sources.) Call it in
#   the folder that makes the target. DEVEL_ONLY: not installed, for tests.
#   Without ROS it only installs.
function(kinescope_expose_to_ros target)
  cmake_parse_arguments(ARG "DEVEL_ONLY" "" "" ${ARGN})
  if(NOT ARG_DEVEL_ONLY)
    install(TARGETS ${target} RUNTIME DESTINATION bin)
  endif()
  if(NOT KINESCOPE_WITH_ROS)
    return()
  endif()
  set(folder ${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_BIN_DESTINATION})
  add_custom_command(TARGET ${target} POST_BUILD
    COMMAND ${CMAKE_COMMAND} -E make_directory ${folder}
    COMMAND ${CMAKE_COMMAND} -E create_symlink $<TARGET_FILE:${target}> ${folder}/$<TARGET_FILE_NAME:${target}>
    VERBATIM)
  if(NOT ARG_DEVEL_ONLY)
    install(CODE "
      set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CATKIN_PACKAGE_BIN_DESTINATION}\")
      file(MAKE_DIRECTORY \"\${folder}\")
      file(CREATE_LINK ../../bin/$<TARGET_FILE_NAME:${target}> \"\${folder}/$<TARGET_FILE_NAME:${target}>\" SYMBOLIC)")
  endif()
endfunction()

if(NOT KINESCOPE_WITH_ROS)
  return()
endif()

# catkin runs whatever python3 comes first on PATH; one without catkin_pkg (pyenv, conda) fails there.
set(PYTHON_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "the Python that has catkin_pkg, genmsg and gencpp")
set(KINESCOPE_INSTALL_HINT
  "apt install $(sed 's/#.*//' packages.txt), or build without ROS: -DKINESCOPE_WITH_ROS=OFF")
find_package(catkin QUIET)
if(NOT catkin_FOUND)
  message(FATAL_ERROR "catkin is missing: ${KINESCOPE_INSTALL_HINT}")
endif()
catkin_package()
# catkin would put every program and library of ours into the devel space; they belong into the build
# folder, and only what ROS starts is linked from there.
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "")
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY "")
