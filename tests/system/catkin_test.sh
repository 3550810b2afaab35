#!/bin/bash
# catkin_test.sh: in a catkin workspace, a fresh clone is configured, makes its message types, fetches the libraries of the page and
# installs both. The program itself is built by the same files, but not here: that would take as long as the whole build.
set -euo pipefail
source=$(cd "$(dirname "$0")/../.." && pwd)
git -C "$source" rev-parse > /dev/null 2>&1 || { echo "skipped: the sources are no clone"; exit 77; }
room=$(mktemp -d)
trap 'rm -rf "$room"' EXIT
fail() { echo "$*" >&2; exit 1; }

mkdir -p "$room/ws/src/kinescope"
git -C "$source" ls-files -z | tar -C "$source" --null -T - -c | tar -C "$room/ws/src/kinescope" -x
cd "$room/ws"
catkin_make -DPYTHON_EXECUTABLE=/usr/bin/python3 kinescope_ros_messages kinescope_web_libraries > catkin.log 2>&1 ||
  fail "catkin_make does not work: $(tail -n 40 catkin.log)"
grep -q '^kinescope/web/all: .*/kinescope_web_libraries' build/CMakeFiles/Makefile2 || fail "all does not fetch the libraries of the page"
for part in web server/ros launch; do  # without modules (cmake/modules.cmake)
  cmake -DCMAKE_INSTALL_COMPONENT=Unspecified -P "build/kinescope/$part/cmake_install.cmake" > install.log 2>&1 || fail "$part is not installed: $(cat install.log)"
  ! grep -q Warning install.log || fail "$part is installed with a warning: $(cat install.log)"
done
share=install/share/kinescope
for file in "$share/web/node_modules/three/build/three.module.js" "$share/msg/JointLoadArray.msg" "$share/srv/SetHandLoad.srv" \
  install/include/kinescope/JointLoadArray.h "$share/launch/xsens_client.launch" devel/share/kinescope/msg/JointLoadArray.msg; do
  [ -s "$file" ] || fail "$file is missing: $(find install -maxdepth 4)"
done
