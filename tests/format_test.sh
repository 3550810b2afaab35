#!/usr/bin/env bash
# Every .h and .cc is as clang-format 14 and .clang-format have it. tests/format_test.sh [--fix]
# Exit code 1 where one is not, with the command that mends it; 77 (skipped) with another version,
# whose idea of some lines differs. --fix: mends them.
set -euo pipefail
cd "$(dirname "$0")/.."

version=$(clang-format --version 2>/dev/null | grep -o 'version [0-9]*' || true)
if [ "$version" != 'version 14' ]; then
  echo "skipped: needs clang-format 14 (Debian 12's package clang-format); found: ${version:-none}"
  exit 77
fi
format() { git ls-files -z --cached --others --exclude-standard -- '*.h' '*.cc' | xargs -0 -n 100 -P 2 clang-format "$@"; }

[ "${1:-}" = --fix ] && { format -i; exit; }
if report=$(format --dry-run -Werror -fno-color-diagnostics 2>&1); then
  echo "$(git ls-files --cached --others --exclude-standard -- '*.h' '*.cc' | wc -l) files, all formatted"
  exit 0
fi
grep -E ' error: ' <<<"$report" | cut -d: -f1-2 | uniq || echo "$report"
echo "these lines are not as clang-format has them; mend them with: tests/format_test.sh --fix"
exit 1
