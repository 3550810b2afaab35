#!/usr/bin/env bash
# Measures how soon and how completely a ROS subscriber has the samples of a suit, at the rates and with the numbers of
# people that suits have, for README.md in this folder. Stamps are receive times: fitted ones are earlier by the jitter of
# the sender. Usage: tests/bench/ros_rates.sh [BUILD] [SECONDS]
# BUILD: a build folder with the benchmark programs, default build/dev. Takes about two minutes.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=$PWD/${1:-build/dev} length=${2:-10}
kinescope=$build/bin/kinescope
. tests/bench/common.sh
master_port=$(port_of)
export ROS_MASTER_URI=http://127.0.0.1:$master_port
start_master

print_machine
for rate in 60 120 240; do
  "$build/tests/bench/bare_publisher" "$rate" & bare=$!
  children+=("$bare")
  echo "$rate Hz, roscpp alone: $("$build/tests/bench/ros_latency" $((rate * length)) "$rate" /bare/joint_states)"
  kill "$bare"; wait "$bare" 2>/dev/null || true
  for people in 1 4; do
    udp=udp://127.0.0.1:$(port_of)
    "$kinescope" bridge "$udp" --ros required --stamps arrival 2>"$work/bridge.log" & bridge=$!
    children+=("$bridge")
    until grep -q 'answers' "$work/bridge.log"; do kill -0 "$bridge"; done
    "$kinescope" stream demo:walk --characters "$people" --rate_hz "$rate" --to "$udp" 2>/dev/null & suit=$!
    children+=("$suit")
    topics() { rostopic list 2>/dev/null | grep -E '^/kinescope/([^/]+/)?joint_states$' || true; }
    until [ "$(topics | wc -l)" -eq "$people" ]; do kill -0 "$bridge"; done
    mapfile -t names < <(topics)
    echo "$rate Hz, people: $people: $("$build/tests/bench/ros_latency" $((rate * length)) "$rate" "${names[@]}")"
    kill "$suit" "$bridge"; wait "$suit" "$bridge" 2>/dev/null || true
  done
done
