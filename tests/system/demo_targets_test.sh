#!/usr/bin/env bash
# What ./demo builds before its page is there contains the programs that it starts, and no other.
# tests/system/demo_targets_test.sh BUILD_FOLDER
set -euo pipefail
line=$(grep -m 1 '^build "$preset" ' "$(dirname "$0")/../../demo")
read -ra targets <<< "${line#build \"\$preset\" }"
commands=$(ninja -C "$1" -t commands "${targets[@]}")
builds() { grep -q -- "-o $1 " <<< "$commands"; }
for program in bin/kinescope libexec/kinescope/kinescope; do
  builds "$program" || { echo "FAILED: '${targets[*]}' does not build $program"; exit 1; }
done
for later in libexec/kinescope/kinescope_tools lib/kinescope/libkinescope_ros.so.new server/ros/libkinescope_ros_node.a; do
  ! grep -q -- " $later" <<< "$commands" || { echo "FAILED: '${targets[*]}' builds $later, which the page does not need"; exit 1; }
done
