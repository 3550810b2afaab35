#!/usr/bin/env bash
# Checks that every .h and .cc is formatted by clang-format 14. tests/format_test.sh [--fix]
# Exit code 1 if a file is not, with the command that formats it; 77 (skipped) with another version of
# clang-format, which formats some lines differently. --fix: formats the files.
set -euo pipefail
cd "$(dirname "$0")/.."

version=$(clang-format --version 2>/dev/null | grep -o 'version [0-9]*' || true)
if [ "$version" != 'version 14' ]; then
  echo "skipped: needs clang-format 14 (package clang-format of Debian 12); found: ${version:-none}"
  exit 77
fi
format() { git ls-files -z --cached --others --exclude-standard -- '*.h' '*.cc' | xargs -0 -n 100 -P 2 clang-format "$@"; }

[ "${1:-}" = --fix ] && { format -i; exit; }
if report=$(format --dry-run -Werror -fno-color-diagnostics 2>&1); then
  echo "$(git ls-files --cached --others --exclude-standard -- '*.h' '*.cc' | wc -l) files, all formatted"
  exit 0
fi
grep -E ' error: ' <<<"$report" | cut -d: -f1-2 | uniq || echo "$report"
echo "these lines are not formatted; run: tests/format_test.sh --fix"
exit 1
