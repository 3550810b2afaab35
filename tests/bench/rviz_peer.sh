#!/usr/bin/env bash
# Compares RViz and Kinescope in one run: the same person with the same motion (for RViz over TF), at
# 1280 x 720 (for RViz a window under Xvfb), rendered by the same Mesa.
# Usage: tests/bench/rviz_peer.sh [BUILD [SECONDS]]
# RViz is set to 1000 frames per second, so it renders as fast as it can. Its pictures stay in the window;
# Kinescope's pictures are also read back. The programs run one after the other, so each has all cores.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=$PWD/${1:-build/dev}
secs=${2:-15}
kinescope=$build/bin/kinescope
work=$(mktemp -d)
children=()
trap 'kill "${children[@]}" 2>/dev/null || true; wait 2>/dev/null || true; rm -rf "$work"' EXIT
port_of() { /usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }
cpu_ticks() { awk '{ print $14 + $15 }' "/proc/$1/stat"; }
swaps() { od -An -t u8 -N 8 "$work/swaps" | tr -d ' '; }
master_port=$(port_of)
export ROS_HOME=$work/ros ROS_IP=127.0.0.1 ROS_MASTER_URI=http://127.0.0.1:$master_port
export HOME=$work LIBGL_ALWAYS_SOFTWARE=1 QT_LOGGING_RULES='*=false'
unset ROS_HOSTNAME

echo "machine: $(nproc) cores, $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -1), load $(cut -d' ' -f1-3 /proc/loadavg)"
/usr/bin/python3 "$(command -v rosmaster)" --core -p "$master_port" >/dev/null 2>&1 & children+=($!)
until (: >"/dev/tcp/127.0.0.1/$master_port") 2>/dev/null; do sleep 0.1; done
"$kinescope" bridge --source demo:lift --ros required 2>"$work/bridge.log" & bridge=$!
children+=("$bridge")
until grep -q live: "$work/bridge.log"; do kill -0 "$bridge" || { cat "$work/bridge.log"; exit 1; }; sleep 0.1; done

mkfifo "$work/display"
Xvfb -displayfd 3 -screen 0 1280x720x24 3>"$work/display" 2>/dev/null & xvfb=$!; children+=("$xvfb")
read -r display <"$work/display"
cat >"$work/peer.rviz" <<'CONFIG'
Panels: []
Visualization Manager:
  Class: ""
  Displays:
    - {Class: rviz/Grid, Name: Floor, Enabled: true, Value: true, Alpha: 0.5, Cell Size: 0.5, Plane: XY, Plane Cell Count: 12, Reference Frame: <Fixed Frame>}
    - {Class: rviz/RobotModel, Name: Human, Enabled: true, Value: true, Alpha: 1, Robot Description: robot_description, Update Interval: 0, Visual Enabled: true, Collision Enabled: false}
    - {Class: rviz/MarkerArray, Name: Loads, Enabled: true, Value: true, Marker Topic: /kinescope/markers, Queue Size: 10}
  Enabled: true
  Global Options: {Background Color: 48; 48; 52, Fixed Frame: world, Frame Rate: 1000}
  Tools: [{Class: rviz/Interact}]
  Value: true
  Views:
    Current: {Class: rviz/Orbit, Name: Current View, Target Frame: <Fixed Frame>, Distance: 3, Yaw: 0.6, Pitch: 0.25, Focal Point: {X: 0, Y: 0, Z: 0.9}, Near Clip Distance: 0.01}
    Saved: ~
Window Geometry: {Height: 720, Width: 1280, X: 0, Y: 0, Hide Left Dock: true, Hide Right Dock: true}
CONFIG
head -c 8 /dev/zero >"$work/swaps"
rviz=$(command -v rviz || echo /usr/lib/rviz/rviz)
DISPLAY=:$display SWAP_COUNTER=$work/swaps LD_PRELOAD=$build/tests/bench/swap_counter.so \
  "$rviz" -d "$work/peer.rviz" --fullscreen --splash-screen '' >"$work/rviz.log" 2>&1 & peer=$!
children+=("$peer")
until [ "$(swaps)" -gt 50 ]; do kill -0 "$peer" || { tail -5 "$work/rviz.log"; exit 1; }; sleep 0.1; done
sleep 5  # the first pictures include loading the model and compiling shaders
if command -v import >/dev/null; then DISPLAY=:$display import -window root "${RVIZ_PICTURE:-$work/rviz.png}"; fi
count=$(swaps) ticks=$(cpu_ticks "$peer") x_ticks=$(cpu_ticks "$xvfb") start=$EPOCHREALTIME
sleep "$secs"
count=$(( $(swaps) - count )) ticks=$(( $(cpu_ticks "$peer") - ticks )) x_ticks=$(( $(cpu_ticks "$xvfb") - x_ticks ))
awk -v n="$count" -v t="$ticks" -v x="$x_ticks" -v s="$EPOCHREALTIME" -v b="$start" -v hz="$(getconf CLK_TCK)" 'BEGIN {
  printf "rviz 1280x720: %.1f pictures/s, CPU %.2f ms per picture (plus %.2f ms of the X server)\n",
         n / (s - b), 1000 * t / hz / n, 1000 * x / hz / n }'
kill "$peer" "$bridge" "$xvfb"; wait "$peer" "$bridge" "$xvfb" 2>/dev/null || true
"$build/tests/bench/picture_rate" "$secs"
