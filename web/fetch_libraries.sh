#!/bin/sh
# fetch_libraries.sh STAMP [NPM]: fetches the libraries of the page, unless they are those of the lock file, and makes STAMP.
# It never fails: a build without a network lacks the page only.
set -eu
stamp=$1 npm=${2:-npm}
cd "$(dirname "$0")"
if ! cmp -s package-lock.json node_modules/.kinescope-lock; then
  if ! npm_config_fetch_retries=1 "$npm" ci --no-audit --no-fund --loglevel=error >&2; then
    echo "warning: the web page lacks its libraries: install npm, check the network connection, and run npm ci --prefix $PWD" >&2
    exit 0
  fi
  cp package-lock.json node_modules/.kinescope-lock
fi
touch "$stamp"
