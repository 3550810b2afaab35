#!/usr/bin/env bash
# Measures whole programs, for README.md in this folder. Usage: tests/bench/measure.sh [BUILD]
# BUILD: a build folder with the benchmark programs, default build/dev. Takes about two minutes.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=$PWD/${1:-build/dev}
kinescope=$build/bin/kinescope
. tests/bench/common.sh

seconds() { local start=$EPOCHREALTIME; "$@" >/dev/null 2>&1; awk "BEGIN { printf \"%.2f\", $EPOCHREALTIME - $start }"; }

print_machine
echo "start to first picture on disk (1280x720): $(seconds "$kinescope" render demo:n_pose --supersample 1 --out "$work/a.png") s," \
     "second run $(seconds "$kinescope" render demo:n_pose --supersample 1 --out "$work/a.png") s"
show_clip() {  # WHAT [options]
  local TIMEFORMAT='%R s, CPU %U + %S s'
  echo "60 s clip, 30 frames per second, $1: $({ time "$kinescope" render demo:lift --seconds 60 --force "${@:2}" >/dev/null 2>&1; } 2>&1)"
}
show_clip "H.264, 1280x720" --supersample 1 --out "$work/a.mp4"
show_clip "H.264, 1280x720, 2x supersampled" --out "$work/a.mp4"
show_clip "H.264, 1920x1080, 2x supersampled" --size 1920x1080 --out "$work/a.mp4"
show_clip "VP9, 1280x720, 2x supersampled" --out "$work/a.webm"
ffprobe -v error -count_frames -show_entries stream=nb_read_frames,r_frame_rate,duration,color_space,color_range -of csv=p=0 "$work/a.mp4"

master_port=$(port_of) http_port=$(port_of) udp_port=$(port_of)
export ROS_MASTER_URI=http://127.0.0.1:$master_port
if command -v rosmaster >/dev/null && [ -x "$build/tests/bench/ros_latency" ]; then
  start_master
fi
start_server() {  # [options]
  "$kinescope" serve --source "udp://127.0.0.1:$udp_port" --http_port "$http_port" "$@" 2>"$work/server.log" & server=$!
  children+=("$server")
  until grep -q 'page at' "$work/server.log"; do kill -0 "$server"; done
}
start_server --stamps arrival  # latency counts from there; fitted stamps are earlier by the jitter of the sender
measure_viewers() {  # VIEWERS [pictures] [stalled=N] [back=N]
  local before viewers=$1; shift; before=$(cpu_ticks "$server")
  echo "$viewers viewer(s) $*: $("$build/tests/bench/page_viewers" "$http_port" "$viewers" 10 "$@" | paste -sd';')" \
       "server CPU $(( $(cpu_ticks "$server") - before ))/1000 of a core, $(rss_mb "$server") MB"
}
"$kinescope" stream demo:lift --rate_hz 60 --to "udp://127.0.0.1:$udp_port" 2>/dev/null & suit=$!
children+=("$suit")
echo "at 60 Hz:"
measure_viewers 1
measure_viewers 20
measure_viewers 20 stalled=1 back=5
measure_viewers 1 pictures
kill "$suit"; wait "$suit" 2>/dev/null || true
# While the stream is live, the next sender would count as a second person instead of the same suit.
until curl -sf "http://127.0.0.1:$http_port/api/v1/state" | grep -q '"liveness":"stale"'; do :; done
"$kinescope" stream demo:lift --rate_hz 240 --to "udp://127.0.0.1:$udp_port" 2>/dev/null & children+=($!)
if [ -x "$build/tests/bench/ros_latency" ]; then
  before=$(cpu_ticks "$server")
  echo "at 240 Hz, sample received to ROS subscriber: $("$build/tests/bench/ros_latency" 2400 240 /kinescope/joint_states)"
  echo "  server CPU $(( $(cpu_ticks "$server") - before ))/1000 of a core, $(rss_mb "$server") MB"
fi
kill "${children[@]}" 2>/dev/null || true; wait 2>/dev/null || true
start_server --ros off
"$kinescope" stream demo:walk --characters 4 --rate_hz 240 --to "udp://127.0.0.1:$udp_port" 2>/dev/null & children+=($!)
"$build/tests/bench/page_viewers" "$http_port" 1 14 pictures >/dev/null  # bodies and shaders are made, the camera has seen a lap
echo "four people at 240 Hz, walking:"
measure_viewers 1
measure_viewers 1 pictures
kill "${children[@]}" 2>/dev/null || true; wait 2>/dev/null || true
types=01,02,03,12,13,20,21,22,23,24,25
"$kinescope" record "udp://127.0.0.1:$udp_port" --out "$work/take.pcap" --seconds 8 --json >"$work/take.json" 2>"$work/record.log" & recorder=$!
until grep -q recording "$work/record.log"; do kill -0 "$recorder"; done
"$kinescope" stream demo:walk --characters 4 --rate_hz 240 --gloves --props 2 --types $types --to "udp://127.0.0.1:$udp_port" 2>/dev/null & children=($!)
before=$(cpu_ticks "$recorder")
while kill -0 "$recorder" 2>/dev/null; do ticks=$(cpu_ticks "$recorder" 2>/dev/null || echo "${ticks:-$before}"); sleep 0.2; done
echo "recording four people at 240 Hz with every message, gloves and props for 8 s: $(/usr/bin/python3 -c '
import json, sys
take = json.load(open(sys.argv[1]))
print(take["datagrams"], "datagrams,", take["samples"], "samples, lost", take["lost"])' "$work/take.json")," \
  "CPU $(( (ticks - before) * 1000 / 800 ))/1000 of a core"
