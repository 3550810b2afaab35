# What ./demo and ./check share: install what is missing, build. To be sourced from the top folder.
# shellcheck shell=bash

say() { printf '\033[1m== %s\033[0m\n' "$*" >&2; }
die() { printf '%s: %s\n' "${0##*/}" "$*" >&2; exit 2; }

# A package is there when dpkg says so, or when the program that it is for is on PATH anyway
# (Node.js often comes from elsewhere, and its packages then conflict with Debian's).
is_installed() {
  case $1 in
    npm) command -v npm >/dev/null && return 0 ;;
    nodejs) command -v node >/dev/null && return 0 ;;
  esac
  [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# install_packages [with-tests]
install_packages() {
  local marked=' # test' missing=() name
  [ "${1:-}" = with-tests ] && marked=''
  while read -r name; do
    is_installed "$name" || missing+=("$name")
  done < <(grep -v '^#' packages.txt | { [ -n "$marked" ] && grep -v '# test' || cat; } |
           sed 's/#.*//' | awk 'NF { print $1 }')
  [ ${#missing[@]} -eq 0 ] && return 0

  local root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null && sudo -n true 2>/dev/null && root=(sudo) ||
      die "may not install packages here; run this once as root: apt-get install --no-install-recommends ${missing[*]}"
  fi
  say "installing ${#missing[@]} Debian packages"
  "${root[@]}" apt-get update -q >/dev/null || die "apt-get update failed; is there a network?"
  "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -yq --no-install-recommends \
    "${missing[@]}" >/dev/null ||
    die "apt-get could not install: ${missing[*]}; if it was interrupted before, run 'dpkg --configure -a' as root"
}

# install_npm FOLDER: what its lock file says, again only when the lock file has changed.
install_npm() {
  local stamp=$1/node_modules/.kinescope-lock
  cmp -s "$1/package-lock.json" "$stamp" && return 0
  say "installing npm packages of $1"
  npm ci --prefix "$1" --no-audit --no-fund --loglevel=error >/dev/null || die "npm ci failed in $1; is there a network?"
  cp "$1/package-lock.json" "$stamp"
}

# take_the_lock: two of us in one folder would build over each other. Descriptor 9 is the lock, and a compiler that goes on after
# this script was killed still holds it.
take_the_lock() {
  { mkdir -p build && : >> build/.lock; } 2>/dev/null ||
    die "cannot write to $PWD/build: make it writable, or clone into a folder that is"
  exec 9> build/.lock
  flock -n 9 || die "another ./check or ./demo is building here: wait for it, or stop it"
}
release_the_lock() { exec 9>&-; }

# run_tests COMMAND...: does not pass the lock on, since a program that outlives its test would keep it.
run_tests() { "$@" 9>&-; }

# enough_room MIB: a build that runs out of it leaves files cut short.
enough_room() {
  local free
  free=$(df -Pm build | awk 'NR == 2 { print $4 }')
  [ "$free" -ge "$1" ] || die "only $free MiB free for $PWD/build, $1 are needed: make room, or clone elsewhere"
}

# build PRESET [TARGET...]: configures anew when the presets have changed or the last time did not come to an end.
build() {
  local preset=$1 folder=build/$1
  shift
  [ -f "$folder/.built" ] || enough_room "$(case $preset in asan) echo 2500 ;; *) echo 1000 ;; esac)"
  if ! cmp -s CMakePresets.json "$folder/.presets"; then
    say "configuring $folder"
    cmake --fresh --preset "$preset" >"$folder.log" 2>&1 || { cat "$folder.log" >&2; die "configuring failed, see above"; }
    cp CMakePresets.json "$folder/.presets"
  fi
  say "building $preset"
  if ! cmake --build "$folder" ${1:+--target "$@"}; then
    enough_room 50
    die "the build failed, see above"
  fi
  touch "$folder/.built"
}
