# Shared by ./demo and ./check: install missing packages, build. Source it from the top folder.
# shellcheck shell=bash

say() { printf '\033[1m== %s\033[0m\n' "$*" >&2; }
die() { printf '%s: %s\n' "${0##*/}" "$*" >&2; exit 2; }

# A package is installed if dpkg lists it, or if the program that it provides is on PATH
# (Node.js is often installed from another source, whose packages conflict with Debian's).
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
      die "no permission to install packages; run this once as root: apt-get install --no-install-recommends ${missing[*]}"
  fi
  say "installing ${#missing[@]} Debian packages"
  "${root[@]}" apt-get update -q >/dev/null || die "apt-get update failed; check the network connection"
  "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -yq --no-install-recommends \
    "${missing[@]}" >/dev/null ||
    die "apt-get cannot install: ${missing[*]}; if an installation was interrupted, run 'dpkg --configure -a' as root"
}

# install_npm FOLDER: installs the packages of its lock file; repeated only if the lock file has changed.
install_npm() {
  local stamp=$1/node_modules/.kinescope-lock
  cmp -s "$1/package-lock.json" "$stamp" && return 0
  say "installing npm packages of $1"
  npm ci --prefix "$1" --no-audit --no-fund --loglevel=error >/dev/null || die "npm ci failed in $1; check the network connection"
  cp "$1/package-lock.json" "$stamp"
}

# install_page_libraries: those of web/, with npm or without it.
install_page_libraries() {
  sh web/fetch_libraries.sh || die "the web page lacks its libraries; check the network connection"
}

# take_the_lock: one ./check or ./demo at a time builds in this folder. Descriptor 9 is the lock; a compiler that keeps running after
# this script was killed still holds it.
take_the_lock() {
  { mkdir -p build && : >> build/.lock; } 2>/dev/null ||
    die "cannot write to $PWD/build: make it writable, or clone into a writable folder"
  exec 9> build/.lock
  flock -n 9 || die "another ./check or ./demo is building in this folder: wait until it ends, or stop it"
}
release_the_lock() { exec 9>&-; }

# run_tests COMMAND...: does not pass the lock on, since a program that outlives its test would keep it.
run_tests() { "$@" 9>&-; }

# enough_room MIB: checks the free disk space, because a build on a full disk leaves truncated files.
enough_room() {
  local free
  free=$(df -Pm build | awk 'NR == 2 { print $4 }')
  [ "$free" -ge "$1" ] || die "only $free MiB free in $PWD/build, $1 MiB needed: free disk space, or clone to another disk"
}

# make_cost_meter: builds made from then on measure what each unit and each test costs (tests/gate/cost.cc).
make_cost_meter() {
  cost_meter=$PWD/build/cost
  [ "$cost_meter" -nt tests/gate/cost.cc ] || clang++ -O1 -std=c++17 tests/gate/cost.cc -o "$cost_meter" ||
    die "compiling tests/gate/cost.cc failed, see above"
  export KINESCOPE_COST_METER=$cost_meter
}

# build PRESET [TARGET...]: configures again if the presets have changed, the last configuration did not finish, or costs are to be
# measured. With keep_going=yes, a source that does not compile does not stop the others.
build() {
  local preset=$1 folder=build/$1
  shift
  [ -f "$folder/.built" ] || enough_room "$(case $preset in asan) echo 2500 ;; *) echo 1000 ;; esac)"
  local fresh=() meter=${KINESCOPE_COST_METER:+-DKINESCOPE_COST_METER:FILEPATH=$KINESCOPE_COST_METER}
  cmp -s CMakePresets.json "$folder/.presets" || fresh=(--fresh)
  if [ ${#fresh[@]} -gt 0 ] || ! { [ -z "$meter" ] || grep -qxF "${meter#-D}" "$folder/CMakeCache.txt"; }; then
    say "configuring $folder"
    cmake "${fresh[@]}" --preset "$preset" ${meter:+"$meter"} >"$folder.log" 2>&1 || { cat "$folder.log" >&2; die "configuring failed, see above"; }
    cp CMakePresets.json "$folder/.presets"
  fi
  say "building $preset"
  if ! cmake --build "$folder" ${1:+--target "$@"} ${keep_going:+-- -k 0}; then
    enough_room 50
    die "the build failed, see above"
  fi
  touch "$folder/.built"
}
