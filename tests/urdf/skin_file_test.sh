#!/usr/bin/env bash
# The skin of the tree is what its sources make. tests/urdf/skin_file_test.sh MAKE_SKIN SKIN_FILE
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$1" "$folder/skin.bin"
cmp "$2" "$folder/skin.bin" || {
  echo "FAILED: $2 is not what urdf/skin/make makes now. Write it again (cmake --build build/asan --target remake_skin),"
  echo "look at the pictures of docs/contact_sheet.sh --postures FOLDER, and commit it."
  exit 1
}
