#!/usr/bin/env bash
# What ./demo builds contains the program that it starts. tests/system/demo_targets_test.sh BUILD_FOLDER
set -euo pipefail
line=$(grep '^build "$preset" ' "$(dirname "$0")/../../demo")
read -ra targets <<< "${line#build \"\$preset\" }"
ninja -C "$1" -t commands "${targets[@]}" | grep -- '-o bin/kinescope ' > /dev/null ||
  { echo "FAILED: '${targets[*]}' does not build bin/kinescope"; exit 1; }
