# Makes this tree a catkin package too, in a catkin workspace and with plain CMake alike: catkin writes
# build/<preset>/devel/, whose setup.bash is all that roslaunch needs to find us.
#
# kinescope_expose_to_ros(<target> [DEVEL_ONLY])
#   Installs an executable, and lets ROS find it as <node pkg="kinescope" type="<target>">, from the
#   devel space and from an install tree. Call it in the folder that makes the target. DEVEL_ONLY: not
#   installed, for tests. Without ROS it only installs.
#   (rosrun finds it too, but looks into no build folder that lies inside the sources.)
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
      set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${KINESCOPE_ROS_BIN}\")
      file(MAKE_DIRECTORY \"\${folder}\")
      file(CREATE_LINK ../../bin/$<TARGET_FILE_NAME:${target}> \"\${folder}/$<TARGET_FILE_NAME:${target}>\" SYMBOLIC)")
  endif()
endfunction()

if(NOT KINESCOPE_WITH_ROS)
  return()
endif()

# In an install tree of a workspace, whose setup.bash knows it, ROS looks for programs in lib/. Elsewhere
# it looks below share/, where ROS_PACKAGE_PATH leads; and catkin must not be let put a setup.bash into
# the prefix: it ignores `cmake --install --prefix` and writes to the one given when configuring.
set(KINESCOPE_ROS_BIN lib/kinescope)
if(PROJECT_IS_TOP_LEVEL AND NOT CATKIN_DEVEL_PREFIX)
  set(CATKIN_INSTALL_INTO_PREFIX_ROOT OFF)
  set(KINESCOPE_ROS_BIN share/kinescope)
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
