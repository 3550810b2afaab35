#!/usr/bin/env bash
# Tests the error messages of ./check and ./demo, and that an interrupted run does not block the next one.
# tests/system/prepare_test.sh. Exit code 1 at the first message that differs.
# Tests that need their own name space (no network, a small disk) are reported as skipped if the kernel does not allow one.
set -uo pipefail
top=$(cd "$(dirname "$0")/../.." && pwd)
room=$(mktemp -d)
trap 'rm -rf "$room"' EXIT
tree=$room/tree
mkdir "$tree"
(cd "$top" && cp -r check demo packages.txt cmake CMakePresets.json "$tree" && mkdir "$tree/web" && cp web/package*.json web/fetch_libraries.sh "$tree/web")
chmod -R a+rX "$room"

fail() { printf 'FAILED: %s\n' "$*"; exit 1; }
# expect TEXT COMMAND...: expects exit code 2 and a last line that contains TEXT.
expect() {
  local text=$1 output code
  shift
  output=$(cd "$tree" && "$@" 2>&1 </dev/null)
  code=$?
  [ $code -eq 2 ] || fail "'$*' ended with $code instead of 2: $output"
  [[ ${output##*$'\n'} == *"$text"* ]] || fail "the last line of '$*' does not contain '$text': $output"
  printf 'ok: %s\n' "${output##*$'\n'}"
}
as_nobody() { if [ "$(id -u)" -eq 0 ]; then setpriv --reuid=65534 --regid=65534 --clear-groups "$@"; else "$@"; fi; }

expect "unknown option '--fast' (see ./check --help)" ./check --fast
expect "unknown option '--fast' (see ./demo --help)" ./demo --fast
expect "--seconds needs a value (see ./demo --help)" ./demo --seconds
expect "--seconds=soon: expected a whole number" ./demo --seconds soon
expect "--ros=perhaps: expected auto or off" ./demo --ros perhaps

# A port in use is reported before the build.
take_ports='import socket, sys
tcp, udp = socket.create_server(("127.0.0.1", 0)), socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
udp.bind(("127.0.0.1", 0))
print(tcp.getsockname()[1], udp.getsockname()[1], flush=True)
sys.stdin.read()'
exec {hold}> >(exec /usr/bin/python3 -c "$take_ports" > "$room/ports")
# read succeeds at the end of the line, so not with the first half of it.
until { read -r tcp udp < "$room/ports"; } 2>/dev/null; do :; done
expect "port $tcp is in use: stop the server that uses it, or choose another port with --port" ./demo --port "$tcp"
expect "UDP port $udp is in use: stop the program that uses it, or choose another port with --udp_port" ./demo --udp_port "$udp"
exec {hold}>&-

# The build folder belongs to another user and is not writable.
[ "$(id -u)" -eq 0 ] && expect "make it writable, or clone into a writable folder" as_nobody ./check

# Without root and with missing packages, the message has the command to run. (With an empty folder, dpkg lists no package.)
mkdir -p "$room/dpkg/info" "$room/dpkg/updates"
: > "$room/dpkg/status"
mkdir -p "$tree/build"
chmod 777 "$tree/build"
chmod -R a+rX "$room"
if as_nobody sudo -n true 2>/dev/null; then
  echo 'skipped: without root (sudo needs no password on this machine)'
else
  for script in ./check ./demo; do
    expect "run this once as root: apt-get install --no-install-recommends ca-certificates" \
      as_nobody env DPKG_ADMINDIR="$room/dpkg" "$script"
  done
fi
rm -rf "$tree/build"

# Only one script builds in a folder. If it is killed while a compiler that it started keeps running, the next run waits for that; a
# process that a test left behind delays nobody.
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
expect "another ./check or ./demo is building in this folder: wait until it ends, or stop it" ./check
end "$holder"
expect "another ./check or ./demo is building in this folder: wait until it ends, or stop it" ./demo
end "$child"
hold run_tests
expect "another ./check or ./demo is building in this folder: wait until it ends, or stop it" ./check
end "$holder"
(cd "$tree" && . cmake/prepare.sh && take_the_lock) || fail "what a test has left behind keeps the lock"
end "$child"
echo 'ok: nothing that a test leaves behind keeps the lock'

# Ctrl-C while ./demo builds the rest: nothing keeps running. Programs stand in for the compiler and for Kinescope.
programs=$room/programs
mkdir -p "$programs" "$tree/build/dev/bin" "$tree/web/node_modules"
cp "$tree/web/package-lock.json" "$tree/web/node_modules/.kinescope-lock"
touch "$tree/build/dev/build.ninja"
cat > "$programs/ninja" <<'S'
#!/bin/sh
case " $* " in *' -n '*) exit ;; esac
echo $$ > "$PIDS/ninja.new" && mv "$PIDS/ninja.new" "$PIDS/ninja" && exec sleep 600
S
cat > "$tree/build/dev/bin/kinescope" <<'S'
#!/bin/sh
[ "$1" != render ] || exit 0
echo $$ > "$PIDS/$1"
[ "$1" != serve ] || printf 'page at http://127.0.0.1:1/\nlive: \n live: \n'
exec sleep 600
S
for program in cmake curl; do printf '#!/bin/sh\n' > "$programs/$program"; done
chmod +x "$programs"/* "$tree/build/dev/bin/kinescope"
# (A background process of a script ignores the signal of Ctrl-C, and so would all that it starts.)
(cd "$tree" && exec env --default-signal=INT PATH="$programs:$PATH" PIDS="$room" ./demo --ros off --port 0 --udp_port 0 > "$room/demo.log" 2>&1) &
demo=$!
until [ -e "$room/ninja" ]; do kill -0 "$demo" 2>/dev/null || fail "./demo ended before it built the rest: $(cat "$room/demo.log")"; done
kill -INT "$demo"
wait "$demo" || fail "./demo ended with $? after Ctrl-C: $(cat "$room/demo.log")"
for program in serve stream ninja; do
  ! kill -0 "$(cat "$room/$program")" 2>/dev/null || fail "$program keeps running after Ctrl-C"
done
(cd "$tree" && . cmake/prepare.sh && take_the_lock) || fail "a ./demo that was stopped keeps the lock"
rm -rf "$tree/build" "$tree/web/node_modules"
echo 'ok: Ctrl-C stops ./demo and what it builds in the background'

# Without npm the libraries of the page come from the registry that npm's settings name, and only with the sum of the lock file.
page=$room/page registry=$room/registry
mkdir -p "$page/src" "$registry/made/-" "$room/home"
cp "$top/web/fetch_libraries.sh" "$page"
echo 'export const made = 1' > "$page/src/made.js"
tar -czf "$registry/made/-/made-1.2.3.tgz" -C "$page" --transform 's/^src/package/' src
lock() {
  printf '%s\n' '{' '  "packages": {' '    "node_modules/made": {' '      "version": "1.2.3",' "      \"integrity\": \"sha512-$1\"" \
    '    }' '  }' '}' > "$page/package-lock.json"
}
exec {served}< <(exec /usr/bin/python3 -u -m http.server 0 --bind 127.0.0.1 --directory "$registry" 2>/dev/null)
web_server=$!
read -r -u "$served" line
echo "registry=${line##*(}" | sed 's|/) .*|/|' > "$room/home/.npmrc"
fetch_without_npm() { env -u npm_config_registry -u NPM_CONFIG_REGISTRY HOME="$room/home" "$@" sh "$page/fetch_libraries.sh" '' /none/npm; }
lock "$(head -c 64 /dev/zero | base64 -w 0)"
fetch_without_npm 2> "$room/fetched" && fail "a package with another sum than that of the lock file is taken"
grep -q 'made-1.2.3.tgz has another SHA-512' "$room/fetched" || fail "a wrong sum is not reported: $(cat "$room/fetched")"
[ ! -e "$page/node_modules/made" ] || fail "a package with a wrong sum is unpacked"
lock "$(sha512sum "$registry/made/-/made-1.2.3.tgz" | cut -d ' ' -f 1 | tr a-f A-F | basenc --base16 -d | base64 -w 0)"
fetch_without_npm npm_config_registry=http://127.0.0.1:1 2> /dev/null && fail "npm_config_registry does not come before ~/.npmrc"
fetch_without_npm || fail "the libraries of the page are not fetched without npm"
cmp -s "$page/src/made.js" "$page/node_modules/made/made.js" || fail "the library of the page is not in its place"
end "$web_server"
fetch_without_npm || fail "libraries that are there are fetched again"
echo 'ok: the libraries of the page are fetched without npm'

if ! unshare --user --map-root-user --mount --net true 2>/dev/null; then
  echo 'skipped: no network, full disk (the kernel does not allow name spaces)'
  exit 0
fi
alone() { unshare --user --map-root-user --mount --net "$@"; }
expect "check the network connection" alone env DPKG_ADMINDIR="$room/dpkg" ./check
expect "check the network connection" alone bash -c '. cmake/prepare.sh; export npm_config_fetch_retries=0 npm_config_cache='"$room"'/npm; install_npm web'
expect "check the network connection" alone bash -c '. cmake/prepare.sh; export npm_config_fetch_retries=0 npm_config_cache='"$room"'/npm; install_page_libraries'
expect "MiB needed: free disk space, or clone to another disk" alone bash -c '
  mkdir -p build && mount -t tmpfs -o size=60m tmpfs build || exit 9
  . cmake/prepare.sh; take_the_lock; build asan'
