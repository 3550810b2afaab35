#!/usr/bin/env bash
# Runs tests again and again under a condition and prints how often each passed, failed and how long it took.
# tests/flaky.sh N [--busy] [--nice] [--one-core] [--random] [ctest argument...]
#   N           how often
#   --busy      beside two busy loops
#   --nice      at the lowest priority, beside a compiler for each core
#   --one-core  on one core
#   --random    in another order each time
# ctest arguments choose the tests: -R RViz -j2. Without --preset or --test-dir they are those of the preset dev.
# Examples: tests/flaky.sh 20 --nice -R Flood        tests/flaky.sh 10 --random --preset asan -j2
# Exit code: 0 all passed each time, 1 a test failed, 2 nothing was tested. Nothing is repeated until it passes.
set -euo pipefail
die() { printf 'flaky.sh: %s\n' "$*" >&2; exit 2; }

case ${1:-} in
  -h|--help) sed -n '2,11s/^# //p' "$0"; exit 0 ;;
  ''|*[!0-9]*|0) die "N=${1:-}: expected how often, a whole number from 1 on (see tests/flaky.sh --help)" ;;
esac
times=$1
shift

loads=() around=() options=(--preset dev)
while [ $# -gt 0 ]; do
  case $1 in
    --busy) loads+=(busy busy) ;;
    --nice) command -v c++ >/dev/null || die "--nice needs a compiler, c++"; around+=(nice -n 19); for ((i = $(nproc); i > 0; --i)); do loads+=(compile); done ;;
    --one-core) around+=(taskset -c "$(sed -n 's/^Cpus_allowed_list:\s*\([0-9]*\).*/\1/p' /proc/self/status)") ;;
    --random) set -- "$@" --schedule-random ;;
    *) break ;;
  esac
  shift
done
case " $* " in *' --preset'*|*' --test-dir'*) options=() ;; esac

room=$(mktemp -d)
pids=()
stop() { for pid in "${pids[@]}"; do kill -- "-$pid" 2>/dev/null || true; done; rm -rf "$room"; }
trap stop EXIT
trap 'exit 130' INT TERM

busy() { while :; do :; done; }
# Many short processes that read many files and take memory, as a build has them.
compile() { while :; do c++ -x c++ -std=c++17 -O2 -S -o /dev/null - <<< '#include <regex>' || exit; done; }
set -m  # each load is a process group, which ends as a whole
for load in "${loads[@]}"; do
  "$load" &
  pids+=($!)
done
set +m

cd "$(dirname "$0")/.."  # where the presets are
logs=${TMPDIR:-/tmp}/flaky.$$
for ((run = 1; run <= times; ++run)); do
  printf 'run %d of %d\n' "$run" "$times" >&2
  "${around[@]}" ctest "${options[@]}" "$@" --no-tests=error --output-on-failure --output-junit "$room/$run.xml" > "$room/log" 2>&1 &&
    continue
  grep -q '<testcase' "$room/$run.xml" 2>/dev/null || { cat "$room/log" >&2; die "ctest has not run any test, see above"; }
  mkdir -p "$logs"
  cp "$room/log" "$logs/$run.log"
done

[ ! -d "$logs" ] || printf 'what failed: %s\n' "$logs"/*.log
/usr/bin/python3 - "$room" <<'P'
import collections
import pathlib
import sys
import xml.etree.ElementTree

tests = collections.defaultdict(list)
for path in pathlib.Path(sys.argv[1]).glob("*.xml"):
    for case in xml.etree.ElementTree.parse(path).getroot().iter("testcase"):
        skipped = case.find("skipped")  # or its program is missing
        state = case.get("status") if skipped is None else "skipped" if skipped.get("message").startswith("SKIP_") else "missing"
        tests[case.get("name")].append((state, float(case.get("time"))))
rows = []
for name, runs in tests.items():
    states = collections.Counter(state for state, _ in runs)
    passed, skipped = states["run"], states["skipped"]
    rows.append((len(runs) - passed - skipped, max(secs for _, secs in runs), passed, skipped, min(secs for _, secs in runs), name))
print(f"{'passed':>6} {'failed':>6} {'skipped':>7} {'shortest':>9} {'longest':>9}  test")
for failed, longest, passed, skipped, shortest, name in sorted(rows):
    print(f"{passed:6} {failed:6} {skipped:7} {shortest:7.2f} s {longest:7.2f} s  {name}")
flaky = sum(row[0] > 0 for row in rows)
print(f"{len(rows)} tests; {flaky} failed at least once")
sys.exit(1 if flaky else 0)
P
