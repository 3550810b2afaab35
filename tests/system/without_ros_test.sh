#!/bin/sh
# without_ros_test.sh PROGRAM: a program linked without ROS needs no ROS library, works, and reports that ROS is missing.
set -eu
if ldd "$1" | grep -E 'libros|libxmlrpcpp|libtf2'; then
  echo "$1 needs these ROS libraries"
  exit 1
fi
"$1" loads demo:lift --seconds 1 >/dev/null
if message=$("$1" bridge demo:lift --ros required 2>&1); then
  echo "bridge started without ROS; expected an error"
  exit 1
fi
case $message in
  *KINESCOPE_WITH_ROS=ON*) ;;
  *) echo "the error does not name KINESCOPE_WITH_ROS=ON: $message"; exit 1 ;;
esac
