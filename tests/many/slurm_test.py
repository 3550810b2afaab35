#!/usr/bin/python3
"""launch/many/slurm_array.sh with Slurm: controller, node and accounting of one machine, as an ordinary user.
Usage: slurm_test.py PROGRAM [--clips N] [--tasks N] [--seconds S] [--accounting]

Two tasks run at a time. The controller requeues one, which finishes; another is killed (signal 9), is not requeued, and finishes when
it is submitted again. --accounting: sacct and our results must agree; needs slurmdbd and mariadb-server, too."""
import argparse
import collections
import os
import pwd
import re
import signal
import tempfile
import time

from slurm_cluster import ACCOUNTING_PROGRAMS, PROGRAMS, Cluster, until
from trials import RECIPES, Study, id_in, need, share_of


def become_ordinary(folder):
    """Root hands the folder to nobody, and works as nobody from here on."""
    if os.geteuid() != 0:
        return
    nobody = pwd.getpwnam("nobody")
    os.chown(folder, nobody.pw_uid, nobody.pw_gid)
    os.setgroups([])
    os.setgid(nobody.pw_gid)
    os.setuid(nobody.pw_uid)


class Array:
    """Arrays of one list, whose tasks are its shares."""

    def __init__(self, cluster, study, shares):
        self.cluster, self.study, self.shares = cluster, study, shares
        self.ids = []

    def submit(self, tasks):
        said = self.cluster.tell("sbatch", "--parsable", f"--array={tasks}", str(RECIPES / "slurm_array.sh"), "jobs.jsonl",
                                 str(self.shares), folder=self.study.folder)
        self.ids.append(said.strip())

    def task(self, share):
        """Of the newest array."""
        return f"{self.ids[-1]}_{share}"

    def state(self, share):
        return self.cluster.ask("squeue", "-h", "-j", self.task(share), "-o", "%T %r").strip()

    def wait(self, limit_secs):
        last = time.monotonic() + limit_secs
        while self.cluster.ask("squeue", "-h"):
            assert time.monotonic() < last, self.cluster.ask("squeue")
            time.sleep(0.2)

    def rows(self):
        """What sacct has of each share: the states of all runs."""
        found = collections.defaultdict(list)
        said = self.cluster.tell("sacct", "-D", "-X", "-n", "-P", "-j", ",".join(self.ids), "-o", "JobID,State,ExitCode")
        for line in said.splitlines():
            name, *end = line.split("|")
            task = re.fullmatch(r"\d+_(\d+)", name)  # until the database knows its array, a task has a number of its own
            if task:
                found[int(task[1])].append(" ".join(end))
        return found


def batch_of(study, share, shares):
    return next(number for number, words in study.processes().items() if f"{share}/{shares}" in words)


def check_accounting(array, killed):
    """Each run of a share is an attempt of its job that was under way. Of one that was killed (signal 9) nothing is known."""
    runs = array.shares + 2
    until("accounting", lambda: sum(len(rows) for rows in array.rows().values()) == runs)
    attempts = collections.Counter()
    for job, result in array.study.results().items():
        share = share_of(job, array.shares)
        attempts[share] = max(attempts[share], result["attempts"])
    for share, rows in sorted(array.rows().items()):
        expected = max(1, attempts[share]) + (share == killed)  # 1: an empty share
        assert len(rows) == expected, f"share {share}: sacct {rows}, attempts {attempts[share]}"
        if len(rows) > 1:
            print(f"share {share}: sacct -D: {', '.join(rows)}; attempts in the results: {attempts[share]}")
    print(f"sacct: {runs} runs of {array.shares} shares; results agree")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--clips", type=int, default=16)
    parser.add_argument("--tasks", type=int, default=4)
    parser.add_argument("--seconds", type=float, default=0.3)
    parser.add_argument("--accounting", action="store_true")
    options = parser.parse_args()
    need({**PROGRAMS, **(ACCOUNTING_PROGRAMS if options.accounting else {})})
    with tempfile.TemporaryDirectory() as folder:
        become_ordinary(folder)
        os.chmod(folder, 0o755)  # munged wants that
        run(options, folder)
    print("ok")


def run(options, folder):
    study = Study(options.program, os.path.join(folder, "study"))
    study.folder.mkdir()
    for i in range(options.clips):
        study.add(f"clip{i:03}", "render", source="demo:lift", seconds=options.seconds, size="160x120", out=f"clip{i:03}.mp4")
    requeued, killed = id_in(1, options.tasks, "requeued"), id_in(2, options.tasks, "killed")
    for job in (requeued, killed):
        study.add_waiting(job)
    study.write_list()
    began = time.monotonic()
    with Cluster(folder, study.environment, options.accounting) as cluster:
        print(f"cluster started in {time.monotonic() - began:.1f} s", flush=True)
        began = time.monotonic()
        array = Array(cluster, study, options.tasks)
        array.submit(f"1-{options.tasks}%2")

        # The controller takes a task back: it ends its files, waits for its start time, and finishes in its second run.
        with study.meet(requeued):
            cluster.tell("scontrol", "requeue", array.task(1))
            until("requeue", lambda: array.state(1) == "PENDING BeginTime")
        assert study.results()[requeued]["state"] == "interrupted", study.results()[requeued]
        study.let_go(requeued)
        # Not at once: slurmd refuses a job that starts again in the second in which it was taken back ("credential revoked"), and it is
        # lost. By itself Slurm waits two minutes.
        cluster.tell("scontrol", "update", f"JobId={array.task(1)}", "StartTime=now+1")

        # Signal 9: Slurm does not requeue it.
        with study.meet(killed):
            os.kill(batch_of(study, 2, options.tasks), signal.SIGKILL)
            until("end of the killed task", lambda: "RUNNING" not in array.state(2))
        study.let_go(killed)
        array.wait(3600)
        checked = study.kinescope("batch", "jobs.jsonl", "--check")
        assert checked.returncode == 1 and f"missing     {killed}" in checked.stdout, checked.stdout
        array.submit("2")
        array.wait(600)
        study.expect_complete()
        print(f"{len(study.jobs)} jobs in {options.tasks} tasks, two at a time: {time.monotonic() - began:.1f} s, CPU "
              f"{sum(result['cpu_seconds'] for result in study.results().values()):.1f} s")
        assert study.results()[requeued]["attempts"] == 2
        # The log of a task that ran twice has both runs.
        log = (study.folder / f"slurm-{array.ids[0]}_1.log").read_text()
        assert "interrupted" in log and "DUE TO JOB REQUEUE" in log and "0 failed" in log.splitlines()[-1], log
        if options.accounting:
            check_accounting(array, killed=2)


main()
