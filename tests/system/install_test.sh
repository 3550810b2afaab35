#!/bin/bash
# install_test.sh BUILD_FOLDER: an installed Kinescope works where neither its sources nor its build folder are: commands, pictures,
# page, launch files and message types.
set -euo pipefail
build=$1
room=$(mktemp -d)
set -m  # each program in the background is a process group, which ends as a whole
stop() { for job in $(jobs -p); do kill -- "-$job" 2> /dev/null || true; done; wait; }
trap 'stop; rm -rf "$room"' EXIT
source=$(cd "$(dirname "$0")/../.." && pwd)

fail() { echo "$*" >&2; exit 1; }
cmake --install "$build" --prefix "$room/opt" > "$room/install.log" || { cat "$room/install.log"; exit 1; }

# A file system of its own, in which the sources and the build folder are empty.
hide() { unshare --user --map-root-user --mount -- /bin/bash -c 'mount -t tmpfs none "$0" && shift 0 && exec "$@"' "$source" "$@"; }
if ! hide true 2>/dev/null; then
  echo "user namespaces are not allowed here, so the sources stay visible"
  hide() { "$@"; }
fi

export HOME=$room XDG_CACHE_HOME=$room/cache
cd "$room"
program=$room/opt/bin/kinescope
hide "$program" render demo:lift --time 1 --size 320x240 --out a.png > /dev/null || fail "render does not work"
hide "$program" golden compare a.png a.png || fail "golden compare does not work"
hide "$program" urdf --out person > /dev/null || fail "urdf does not work"

hide "$program" serve demo:lift --ros off --http_port 0 --pictures off 2> serve.log &
for _ in $(seq 600); do grep -q 'page at ' serve.log && break; sleep 0.1; done  # another process writes the file
page=$(sed -n 's/.*page at \(http[^ ]*\).*/\1/p' serve.log)
[ -n "$page" ] || fail "serve does not start: $(cat serve.log)"
for file in '' app.js lib/three/three.module.js lib/uplot/uPlot.esm.js; do
  curl -sf "$page$file" > page.txt || fail "the page has no $file"
  [ -s page.txt ] || fail "$file of the page is empty"
done
bundle=$room/opt/share/kinescope/web/bundle/app.js
curl -sf "${page}app.js" | cmp -s - "$bundle" || fail "the page is not served as $bundle"
stop

[ -d "$room/opt/share/kinescope/launch" ] || { echo "without ROS"; exit 0; }
export ROS_HOME=$room/ros ROS_IP=127.0.0.1 ROS_PACKAGE_PATH=$room/opt/share:/usr/share PYTHONPATH=$room/opt/lib/python3/dist-packages
unset ROS_HOSTNAME CMAKE_PREFIX_PATH
printf '#include <kinescope/JointLoadArray.h>\n#include <kinescope/SetHandLoad.h>\nkinescope::JointLoadArray loads;\n' > use.cc
g++ -std=c++17 -fsyntax-only -I "$room/opt/include" use.cc || fail "the installed headers of our messages cannot be used"
/usr/bin/python3 "$(command -v rosmsg)" show kinescope/JointLoadArray > show.txt || fail "rosmsg does not know kinescope/JointLoadArray"
grep -q joint show.txt || fail "rosmsg shows another message: $(cat show.txt)"
/usr/bin/python3 "$(command -v rossrv)" show kinescope/SetHandLoad > /dev/null || fail "rossrv does not know kinescope/SetHandLoad"
port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
export ROS_MASTER_URI=http://127.0.0.1:$port
hide /usr/bin/python3 "$(command -v roslaunch)" -p "$port" kinescope demo.launch http_port:=0 pictures:=off > launch.log 2>&1 &
echo_load() { timeout 60 /usr/bin/python3 "$(command -v rostopic)" echo -n1 "$@"; }
for _ in $(seq 600); do grep -q 'ROS master at .* answers' launch.log && break; sleep 0.1; done
echo_load /kinescope/joint_loads > load.txt || fail "demo.launch publishes no loads: $(cat launch.log)"
grep -q 'load_class\|class' load.txt || fail "rostopic does not show our type: $(cat load.txt)"
hide "$program" rviz --out mine.rviz || fail "kinescope rviz does not work"
grep -q '"/kinescope/markers"' mine.rviz || fail "mine.rviz does not show the markers"
