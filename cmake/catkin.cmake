# Makes this tree a catkin package too, in a catkin workspace and with plain CMake alike: catkin writes
# build/<preset>/devel/, whose setup.bash is all that roslaunch needs to find us.
if(NOT KINESCOPE_WITH_ROS)
  return()
endif()
# catkin runs whatever python3 comes first on PATH; one without catkin_pkg fails there.
set(PYTHON_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "the Python that has catkin_pkg")
find_package(catkin QUIET)
if(NOT catkin_FOUND)
  message(FATAL_ERROR "catkin is missing. Install it with: apt install $(sed 's/#.*//' packages.txt). "
    "Or build without ROS: -DKINESCOPE_WITH_ROS=OFF")
endif()
catkin_package()
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "")
