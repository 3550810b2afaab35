#!/usr/bin/env bash
# ros_module_test.sh BUILD_FOLDER WITH_ROS: ROS is in a module alone. The programs link none of its libraries; without the module they
# work, name it and the way out, and a server takes it when it comes.
set -euo pipefail
build=$1 with_ros=$2
exports=$(realpath "$(dirname "$0")/../../server/ros/exports.map")
room=$(mktemp -d)
server='' master=''
trap 'kill $server $master 2> /dev/null || true; wait; rm -rf "$room"' EXIT
fail() { echo "FAILED: $*" >&2; exit 1; }

for program in bin/kinescope libexec/kinescope/kinescope libexec/kinescope/kinescope_tools; do
  ! ldd "$build/$program" | grep -E 'libros|libxmlrpcpp|libtf2|libimage_transport' || fail "$program links these ROS libraries"
done

# A program without its module, as ./demo has it while the module is still being built.
mkdir -p "$room"/{bin,libexec/kinescope,lib/kinescope}
cp "$build/bin/kinescope" "$room/bin"
cp "$build"/libexec/kinescope/kinescope{,_tools} "$room/libexec/kinescope"
cd "$room"
port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
export ROS_MASTER_URI=http://127.0.0.1:$port ROS_IP=127.0.0.1 ROS_HOME=$room/ros

case $with_ros in ON) missing='libkinescope_ros.so .*build or install' ;; *) missing='KINESCOPE_WITH_ROS=ON' ;; esac
# refused WORDS...: a command that needs ROS ends with exit code 2 and the way out.
refused() {
  local code=0
  bin/kinescope "$@" 2> error.txt || code=$?
  [ "$code" = 2 ] || fail "kinescope $*: exit code $code without ROS; expected 2"
  grep -q "$missing" error.txt || fail "kinescope $*: the error does not name the way out: $(cat error.txt)"
}
refused bridge demo:lift --ros required
grep -q -e '--ros=off' error.txt || fail "the error does not name --ros=off: $(cat error.txt)"
refused inspect ros: --seconds 1
refused rviz --out x.rviz
bin/kinescope loads demo:lift --seconds 1 > loads.txt || fail "loads needs ROS"

# serve OPTION... starts the server; await TEXT: up to a line with it.
serve() { bin/kinescope serve demo:lift --http_port 0 --pictures off "$@" 2> serve.log & server=$!; }
await() {
  for _ in $(seq 600); do ! grep -q "$1" serve.log || return 0; sleep 0.1; done  # another process writes the file
  fail "no '$1' in the log: $(cat serve.log)"
}
stop() {
  kill -INT "$server"
  wait "$server" || fail "the server ends with exit code $?: $(cat serve.log)"
  server=
}
serve --ros off
await 'page at '
stop
! grep -i ros serve.log || fail "--ros off says this of ROS"

serve --ros auto
await 'page at '
[ "$with_ros" = ON ] || { stop; exit 0; }
await 'ROS is not used yet: libkinescope_ros.so '
echo 'not a library' > lib/kinescope/libkinescope_ros.so  # as one without the ROS packages
await 'ROS is not used yet: cannot load .*packages.txt'
/usr/bin/python3 "$(command -v rosmaster)" --core -p "$port" > master.log 2>&1 & master=$!
ln -sf "$(realpath "$build/lib/kinescope/libkinescope_ros.so")" lib/kinescope
await 'ROS is used now: '
await "ROS master at $ROS_MASTER_URI/* answers"
stop

# ROS's libraries find these in the module before their own (server/ros/exports.map).
found=$(nm -D --defined-only lib/kinescope/libkinescope_ros.so | awk '{ print $3 }' | sort)
for symbol in $(sed -nE 's/^ *(_Z[A-Za-z0-9_]*)\*?;/\1/p' "$exports"); do
  grep -q "^$symbol" <<< "$found" || fail "the module does not define $symbol"
done
