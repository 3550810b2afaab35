#!/usr/bin/env bash
# Compares RViz and Kinescope in one run: the same person with the same motion (for RViz over TF), at
# 1280 x 720 (for RViz a window under Xvfb), rendered by the same Mesa.
# Usage: tests/bench/rviz_peer.sh [BUILD [SECONDS [ROUNDS]]]
# RViz is set to 1000 frames per second, so it renders as fast as it can. Its pictures stay in the window;
# Kinescope's pictures are also read back. The programs run one after the other, so each has all cores: in each round
# RViz, Kinescope with the rigid parts of the URDF (--figure urdf, the body that RViz has), and with the skin.
# Start: of RViz until it swaps buffers for the first time, with or without the person; of Kinescope until a PNG file is
# complete. Memory: resident, of the process that draws.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=$PWD/${1:-build/dev}
secs=${2:-15}
rounds=${3:-2}
kinescope=$build/bin/kinescope
. tests/bench/common.sh
secs_since() { awk "BEGIN { printf \"%.2f\", $EPOCHREALTIME - $1 }"; }
swaps() { od -An -t u8 -N 8 "$work/swaps" | tr -d ' '; }
master_port=$(port_of)
export ROS_MASTER_URI=http://127.0.0.1:$master_port
export HOME=$work LIBGL_ALWAYS_SOFTWARE=1 QT_LOGGING_RULES='*=false'

print_machine
start_master
mkfifo "$work/display"
Xvfb -displayfd 3 -noreset -screen 0 1280x720x24 3>"$work/display" 2>/dev/null & xvfb=$!; children+=("$xvfb")
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
rviz=$(command -v rviz || echo /usr/lib/rviz/rviz)

measure_rviz() {
  local bridge peer start first count ticks x_ticks
  : >"$work/bridge.log"
  "$kinescope" bridge --source demo:lift --ros required 2>"$work/bridge.log" & bridge=$!
  children+=("$bridge")
  until grep -q live: "$work/bridge.log"; do kill -0 "$bridge" || { cat "$work/bridge.log" >&2; exit 1; }; sleep 0.1; done
  head -c 8 /dev/zero >"$work/swaps"
  start=$EPOCHREALTIME
  DISPLAY=:$display SWAP_COUNTER=$work/swaps LD_PRELOAD=$build/tests/bench/swap_counter.so \
    "$rviz" -d "$work/peer.rviz" --fullscreen --splash-screen '' >"$work/rviz.log" 2>&1 & peer=$!
  children+=("$peer")
  until [ "$(swaps)" -gt 0 ]; do kill -0 "$peer" || { tail -5 "$work/rviz.log" >&2; exit 1; }; sleep 0.01; done
  first=$(secs_since "$start")
  until [ "$(swaps)" -gt 50 ]; do kill -0 "$peer" || { tail -5 "$work/rviz.log" >&2; exit 1; }; sleep 0.1; done
  sleep 5  # the first pictures include loading the model and compiling shaders
  if command -v import >/dev/null; then DISPLAY=:$display import -window root "${RVIZ_PICTURE:-$work/rviz.png}"; fi
  count=$(swaps) ticks=$(cpu_ticks "$peer") x_ticks=$(cpu_ticks "$xvfb") start=$EPOCHREALTIME
  sleep "$secs"
  count=$(( $(swaps) - count )) ticks=$(( $(cpu_ticks "$peer") - ticks )) x_ticks=$(( $(cpu_ticks "$xvfb") - x_ticks ))
  awk -v n="$count" -v t="$ticks" -v x="$x_ticks" -v s="$EPOCHREALTIME" -v b="$start" -v hz="$(getconf CLK_TCK)" \
    -v mb="$(rss_mb "$peer")" -v first="$first" 'BEGIN {
    printf "rviz 1280x720: %.1f pictures/s, CPU %.2f ms a picture (plus %.2f ms of the X server), %s MB, first picture after %s s\n",
           n / (s - b), 1000 * t / hz / n, 1000 * x / hz / n, mb, first }'
  kill "$peer" "$bridge"; wait "$peer" "$bridge" 2>/dev/null || true
}

# measure_kinescope FIGURE
measure_kinescope() {
  "$build/tests/bench/picture_rate" "$secs" "$1"
  local start=$EPOCHREALTIME
  "$kinescope" render demo:lift --figure "$1" --supersample 1 --no_overlays --no_sidecar --force --out "$work/first.png" >/dev/null
  echo "kinescope $1: first picture on disk after $(secs_since "$start") s"
}

# Of the lines of a round: each figure divided by that of RViz.
print_ratios() {
  awk '
    function number(before) { return match($0, "[0-9.]+ " before) ? substr($0, RSTART) + 0 : 0 }
    { rate = number("pictures/s"); cpu = number("ms a picture"); memory = number("MB"); start = number("s$"); sub(/:.*/, "") }
    /^rviz/ { of_rate = rate; of_cpu = cpu; of_memory = memory; of_start = start; next }
    rate > 0 { printf "of RViz, %s: CPU %.2f, pictures/s %.1f, memory %.2f\n", $0, cpu / of_cpu, rate / of_rate, memory / of_memory; next }
    { printf "of RViz, %s: start %.2f\n", $0, start / of_start }' "$work/round"
}

for ((round = 1; round <= rounds; ++round)); do
  echo "round $round, load $(cut -d' ' -f1 /proc/loadavg)"
  { measure_rviz; measure_kinescope urdf; measure_kinescope skin; } >"$work/round"
  cat "$work/round"
  print_ratios
done
