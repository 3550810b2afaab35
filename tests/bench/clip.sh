#!/usr/bin/env bash
# Measures clips in one run: CPU time, wall time and peak memory of the whole process, minima of the rounds.
# Usage: tests/bench/clip.sh [BUILD [SECONDS [ROUNDS [OTHER]]]]
# BUILD: a build folder, default build/dev. SECONDS: length of the clips, default 60. ROUNDS: default 3.
# OTHER: the program of another version, which takes turns with that of BUILD.
# x264 alone: ffmpeg encodes the same pictures, the first 10 s of them, from a file of raw planes, with the former
# settings and with ours. RViz, where it is installed: tests/bench/rviz_peer.sh, without an encoder.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=$PWD/${1:-build/dev}
secs=${2:-60}
rounds=${3:-3}
other=${4:-}
work=$(mktemp -d -p "${TMPDIR:-/tmp}")
trap 'rm -rf "$work"' EXIT

cat >"$work/measure.py" <<'PYTHON'
import os, subprocess, sys, time
log, label, command = sys.argv[1], sys.argv[2], sys.argv[3:]
start = time.monotonic()
child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
_, status, usage = os.wait4(child.pid, 0)
wall = time.monotonic() - start
if status != 0: sys.exit(f"{label}: exit status {status}: {' '.join(command)}")
print(label, usage.ru_utime + usage.ru_stime, wall, usage.ru_maxrss / 1024, sep="\t", file=open(log, "a"))
PYTHON
measure() { /usr/bin/python3 "$work/measure.py" "$work/log" "$@"; }  # LABEL COMMAND...
show() {  # PICTURES: minima of the log; of the memory the largest
  awk -F'\t' -v pictures="$1" '
    !($1 in cpu) { order[++n] = $1; cpu[$1] = $2; wall[$1] = $3 }
    { if ($2 < cpu[$1]) cpu[$1] = $2; if ($3 < wall[$1]) wall[$1] = $3; if ($4 > mb[$1]) mb[$1] = $4 }
    END { for (i = 1; i <= n; ++i) { l = order[i]; printf "%-44s CPU %6.2f s, %5.1f ms a picture; wall %6.2f s; %4.0f MB\n", l, cpu[l], 1000 * cpu[l] / pictures, wall[l], mb[l] } }
  ' "$work/log"
  rm "$work/log"
}

echo "machine: $(nproc) cores, $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -1), load $(cut -d' ' -f1-3 /proc/loadavg)"
programs=("$build/bin/kinescope" ${other:+"$other"})
render() {  # LABEL [options]
  local program
  for program in "${programs[@]}"; do
    measure "$1$([ "$program" = "$other" ] && echo ", other version")" \
      "$program" render demo:lift --seconds "$secs" --force --no_sidecar --out "$work/clip.mp4" "${@:2}"
  done
}
for ((round = 0; round < rounds; ++round)); do
  render "default clip, 1280x720, 2x supersampled"
  render "without supersampling" --supersample 1
  render "1920x1080" --size 1920x1080
  render "camera goes round, 12 degrees per second" --orbit 12
done
show $((30 * secs))

"${programs[0]}" render demo:lift --seconds 10 --crf 0 --force --no_sidecar --out "$work/clip.mp4" >/dev/null
ffmpeg -v error -i "$work/clip.mp4" -f rawvideo -pix_fmt yuv420p "$work/clip.yuv"
encode() {  # LABEL [options]
  measure "$1" ffmpeg -nostdin -v error -y -f rawvideo -pix_fmt yuv420p -s 1280x720 -r 30 -i "$work/clip.yuv" \
    -c:v libx264 -preset veryfast -crf 18 "${@:2}" "$work/encoded.mp4"
}
for ((round = 0; round < rounds; ++round)); do
  measure "reading the raw planes alone" ffmpeg -nostdin -v error -f rawvideo -pix_fmt yuv420p -s 1280x720 -r 30 -i "$work/clip.yuv" -f null -
  encode "x264 alone, former settings" -g 60 -threads 4
  encode "x264 alone, our settings" -g 150 -threads 2 -subq 1 -weightp 0
done
show 300

if command -v rviz >/dev/null || [ -x /usr/lib/rviz/rviz ]; then
  tests/bench/rviz_peer.sh "${1:-build/dev}" 10 1 | grep '^rviz'
fi
