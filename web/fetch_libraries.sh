#!/bin/sh
# fetch_libraries.sh [STAMP [NPM]]: fetches the libraries of the page, unless they are those of the lock file. Exit code 1: it cannot.
# With a STAMP, which it then makes, it never fails: a build without a network lacks the page only.
# Where npm is missing it does without, because npm is four hundred packages of Debian, for two of the page.
set -eu
stamp=${1:-} npm=${2:-npm}
cd "$(dirname "$0")"

# Where npm would look: its settings in the environment, those of the user, its default.
registry() {
  url=${npm_config_registry:-${NPM_CONFIG_REGISTRY:-}}
  [ -n "$url" ] || url=$(sed -n 's/^ *registry *= *//p' "${HOME:-}/.npmrc" 2>/dev/null | tail -n 1)
  url=${url:-https://registry.npmjs.org}
  echo "${url%/}"
}

# "NAME VERSION SUM" of each package, as npm writes the lock file: a key per line.
locked() {
  awk -F '"' '$2 ~ /^node_modules\// { name = substr($2, 14) } $2 == "version" { version = $4 }
    $2 == "integrity" { print name, version, substr($4, 8) }' package-lock.json
}

# fetch NAME VERSION SUM: its files are in place when all have come and the sum is right.
fetch() {
  url=$(registry)/$1/-/$1-$2.tgz new=node_modules/.new-$1
  rm -rf "$new" && mkdir -p "$new/package"
  curl -fsSL --retry 1 --connect-timeout 30 -o "$new/package.tgz" "$url" || return
  if [ "$(sha512sum "$new/package.tgz" | cut -d ' ' -f 1)" != "$(echo "$3" | base64 -d | od -An -v -tx1 | tr -d ' \n')" ]; then
    echo "$url has another SHA-512 than package-lock.json says" >&2
    return 1
  fi
  tar -xzf "$new/package.tgz" -C "$new/package" --strip-components 1 --no-same-owner || return
  rm -rf "node_modules/$1" && mv "$new/package" "node_modules/$1" && rm -r "$new"
}

fetch_all() {
  if command -v "$npm" > /dev/null; then
    npm_config_fetch_retries=1 "$npm" ci --no-audit --no-fund --loglevel=error >&2
    return
  fi
  packages=$(locked)
  while read -r name version sum; do
    fetch "$name" "$version" "$sum" || return
  done <<PACKAGES
$packages
PACKAGES
}

if ! cmp -s package-lock.json node_modules/.kinescope-lock; then
  if fetch_all; then
    cp package-lock.json node_modules/.kinescope-lock
  else
    echo "warning: the web page lacks its libraries: check the network connection, or install npm if your registry wants a password; then run sh $PWD/fetch_libraries.sh" >&2
    [ -n "$stamp" ] || exit 1
    exit 0
  fi
fi
[ -z "$stamp" ] || touch "$stamp"
