#!/bin/sh
# without_ros_test.sh MAIN TOOLS: the two programs of commands, linked without ROS, need no ROS library, work, and report that ROS is missing.
set -eu
for program; do
  if ldd "$program" | grep -E 'libros|libxmlrpcpp|libtf2'; then
    echo "$program needs these ROS libraries"
    exit 1
  fi
done
"$2" loads demo:lift --seconds 1 >/dev/null
if message=$("$1" bridge demo:lift --ros required 2>&1); then
  echo "bridge started without ROS; expected an error"
  exit 1
fi
case $message in
  *KINESCOPE_WITH_ROS=ON*) ;;
  *) echo "the error does not name KINESCOPE_WITH_ROS=ON: $message"; exit 1 ;;
esac
