#!/bin/bash
# Does a list of jobs with GNU parallel: each of its tasks is a share of the list.
#   parallel.sh LIST SHARES [OPTIONS OF kinescope batch]
#   PARALLEL='--jobs 4' parallel.sh jobs.jsonl 64 --retry failed
# The same command goes on after an interruption. Exit code: 0 if the whole list is complete, else 1.
# docs/many_machines.md
set -u
[ $# -ge 2 ] || { sed -n '2,4s/^# //p' "$0" >&2; exit 2; }
list=$1 shares=$2

# A share may take 10 s to end its files; GNU parallel alone kills after 0.4 s. There is no --resume: it goes by the number
# of a task, so it would leave out jobs that were added to the list. A share that is complete takes a moment.
# A session of its own: a task that it begins while it is stopped is not among those that it stops, but in its session.
setsid parallel --quote --joblog "${list%.jsonl}.parallel.log" --term-seq TERM,10000,KILL,25 \
  kinescope batch "$list" "${@:3}" --shard "{}/$shares" < <(seq "$shares") &
trap 'kill -TERM $!' TERM INT HUP
until wait $!; [ $? -le 128 ] || ! kill -0 $! 2>/dev/null; do :; done
pkill -TERM --session $! && pidwait --session $!

# Exit code and log of GNU parallel do not tell: after SIGHUP it ends with 0 though tasks were never begun, and after SIGTERM
# its log lacks those that were running.
exec kinescope batch "$list" --check
