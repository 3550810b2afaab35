#!/usr/bin/env bash
# What ./check and ./demo say where they cannot go on, and that nothing they leave behind stands in the way of the next run.
# tests/system/prepare_test.sh. Exit code 1 at the first sentence that is not as it should be.
# What needs a name space of its own (no network, a small disk) is skipped, visibly, where the kernel gives us none.
set -uo pipefail
top=$(cd "$(dirname "$0")/../.." && pwd)
room=$(mktemp -d)
trap 'rm -rf "$room"' EXIT
tree=$room/tree
mkdir "$tree"
(cd "$top" && cp -r check demo packages.txt cmake CMakePresets.json "$tree" && mkdir "$tree/web" && cp web/package*.json "$tree/web")
chmod -R a+rX "$room"

fail() { printf 'FAILED: %s\n' "$*"; exit 1; }
# expect TEXT COMMAND...: exit code 2, and a last line with TEXT.
expect() {
  local text=$1 output code
  shift
  output=$(cd "$tree" && "$@" 2>&1 </dev/null)
  code=$?
  [ $code -eq 2 ] || fail "'$*' ended with $code instead of 2: $output"
  [[ ${output##*$'\n'} == *"$text"* ]] || fail "the last line of '$*' is without '$text': $output"
  printf 'ok: %s\n' "${output##*$'\n'}"
}
as_nobody() { if [ "$(id -u)" -eq 0 ]; then setpriv --reuid=65534 --regid=65534 --clear-groups "$@"; else "$@"; fi; }

expect "unknown option '--fast' (see ./check --help)" ./check --fast
expect "unknown option '--fast' (see ./demo --help)" ./demo --fast
expect "--seconds needs a value (see ./demo --help)" ./demo --seconds
expect "--seconds=soon: expected a whole number" ./demo --seconds soon
expect "--ros=perhaps: expected auto or off" ./demo --ros perhaps

# A port that is taken is told before anything is built.
take_ports='import socket, sys
tcp, udp = socket.create_server(("127.0.0.1", 0)), socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
udp.bind(("127.0.0.1", 0))
print(tcp.getsockname()[1], udp.getsockname()[1], flush=True)
sys.stdin.read()'
exec {hold}> >(exec /usr/bin/python3 -c "$take_ports" > "$room/ports")
until [ -s "$room/ports" ]; do :; done
read -r tcp udp < "$room/ports"
expect "port $tcp is taken: stop what serves there, or take another one with --port" ./demo --port "$tcp"
expect "UDP port $udp is taken: stop what listens there, or take another one with --udp_port" ./demo --udp_port "$udp"
exec {hold}>&-

# Nobody may write: into a folder of somebody else's, without root, or with a lock that somebody else made.
[ "$(id -u)" -eq 0 ] && expect "make it writable, or clone into a folder that is" as_nobody ./check

# Without root, where packages are missing: the command to run once. (To dpkg with an empty folder, nothing is installed.)
mkdir -p "$room/dpkg/info" "$room/dpkg/updates"
: > "$room/dpkg/status"
mkdir -p "$tree/build"
chmod 777 "$tree/build"
chmod -R a+rX "$room"
if as_nobody sudo -n true 2>/dev/null; then
  echo 'skipped: without root (sudo asks for nothing here)'
else
  for script in ./check ./demo; do
    expect "run this once as root: apt-get install --no-install-recommends ca-certificates" \
      as_nobody env DPKG_ADMINDIR="$room/dpkg" "$script"
  done
fi
rm -rf "$tree/build"

# One at a time in a folder. Killed while a compiler that it has started goes on, the next run waits for that; what a test has
# left behind holds up nobody.
cat > "$room/holder.sh" <<'S'
cd "$1"
. cmake/prepare.sh
take_the_lock
$2 bash -c 'sleep 600 >&- & echo "$!"'
exec sleep 600 >&-
S
hold() {
  exec {started}< <(exec bash "$room/holder.sh" "$tree" "$1")
  holder=$!
  read -r -u "$started" child
}
end() {
  kill -KILL "$1"
  while kill -0 "$1" 2>/dev/null; do :; done
}
hold ''
expect "another ./check or ./demo is building here: wait for it, or stop it" ./check
end "$holder"
expect "another ./check or ./demo is building here: wait for it, or stop it" ./demo
end "$child"
hold run_tests
expect "another ./check or ./demo is building here: wait for it, or stop it" ./check
end "$holder"
(cd "$tree" && . cmake/prepare.sh && take_the_lock) || fail "what a test has left behind keeps the lock"
end "$child"
echo 'ok: nothing that a test leaves behind keeps the lock'

if ! unshare --user --map-root-user --mount --net true 2>/dev/null; then
  echo 'skipped: no network, full disk (the kernel gives no name spaces here)'
  exit 0
fi
alone() { unshare --user --map-root-user --mount --net "$@"; }
expect "is there a network?" alone env DPKG_ADMINDIR="$room/dpkg" ./check
expect "is there a network?" alone bash -c '. cmake/prepare.sh; export npm_config_fetch_retries=0 npm_config_cache='"$room"'/npm; install_npm web'
expect "are needed: make room, or clone elsewhere" alone bash -c '
  mkdir -p build && mount -t tmpfs -o size=60m tmpfs build || exit 9
  . cmake/prepare.sh; take_the_lock; build asan'
