#!/bin/bash
# Does a list of jobs on a Slurm cluster: each task of an array is a share of the list.
#   sbatch --array=1-SHARES%AT_ONCE slurm_array.sh LIST SHARES [OPTIONS OF kinescope batch]
#   sbatch --array=1-200%16 slurm_array.sh jobs.jsonl 200
#   sbatch --array=7,12 slurm_array.sh jobs.jsonl 200 --retry failed       (two shares again)
# Choose SHARES so that each has a minute of work or more, and at most 1000: Slurm's limit of an array.
# docs/many_machines.md
#SBATCH --job-name=kinescope
#SBATCH --cpus-per-task=1
#SBATCH --mem-per-cpu=512M
#SBATCH --output=slurm-%A_%a.log
#SBATCH --open-mode=append
#SBATCH --requeue
#SBATCH --signal=B:TERM@60
# append: a task that is requeued does not wipe the log of its first run. --signal: a minute before the time limit, the task
# ends its files and exits with 143, which is requeued where slurm.conf has RequeueExit=143.

[ $# -ge 2 ] && [ -n "${SLURM_ARRAY_TASK_ID:-}" ] || { sed -n '2,5s/^# //p' "$0" >&2; exit 2; }
# exec: Slurm's signals and the exit code are those of kinescope.
exec kinescope batch "$1" --shard "$SLURM_ARRAY_TASK_ID/$2" --jobs "${SLURM_CPUS_PER_TASK:-1}" "${@:3}"
