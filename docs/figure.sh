#!/usr/bin/env bash
# Draws docs/figure.png: the journal's figure of docs/pictures.md, by the command there.
# docs/figure.sh [PROGRAM]
set -euo pipefail
cd "$(dirname "$0")/.."
program=$(realpath "${1:-build/dev/bin/kinescope}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
command=$(sed -n '/^kinescope render demo:lift --views time:0,1.3/,/--out/p' docs/pictures.md)
(cd "$folder" && eval "${command/kinescope/\"$program\"} --no_sidecar" > /dev/null)
cp "$folder/figure.png" docs/figure.png
