#!/bin/sh
# without_ros_test.sh PROGRAM: a program that was linked without ROS needs none of its libraries, works, and says what is missing.
set -eu
if ldd "$1" | grep -E 'libros|libxmlrpcpp|libtf2'; then
  echo "$1 needs these libraries of ROS"
  exit 1
fi
"$1" loads demo:lift --seconds 1 >/dev/null
if message=$("$1" bridge demo:lift --ros required 2>&1); then
  echo "bridge works without ROS?"
  exit 1
fi
case $message in
  *KINESCOPE_WITH_ROS=ON*) ;;
  *) echo "not a word on how to get ROS: $message"; exit 1 ;;
esac
