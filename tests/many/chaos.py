#!/usr/bin/python3
"""Kills `kinescope batch` and its workers at random; in the end the list is complete and has the same bytes as without kills.
Usage: chaos.py PROGRAM [--jobs N] [--shares N] [--kills N] [--at_once N] [--seed N]

A kill is a signal (SIGTERM or SIGKILL) to a batch, to one of its workers or to all of them in any order, as schedulers send it. A
share that ends before it is complete is started again, as schedulers do. The moments are numbers of ended jobs, and a part of a
job after that, so all kills come before the end, however busy the machine is."""
import argparse
import collections
import os
import pathlib
import queue
import random
import signal
import subprocess
import tempfile
import threading
import time

from trials import Study

COMPLETE = 0
FAILED = 1  # its worker was killed
TERMINATED = 128 + signal.SIGTERM
TERMINATED_AT_ONCE = -signal.SIGTERM  # a second SIGTERM does not wait
KILLED = -signal.SIGKILL


def write_study(study, jobs):
    """Every command whose outputs have the same bytes each time, and jobs of several lengths."""
    study.record("lift.mvnx")
    for i in range(jobs):
        name = f"job{i:04}"
        kind = i % 4
        if kind == 0:
            study.add(name, "render", source="lift.mvnx", size="64x64", camera=["front", "side"][i % 3 == 0], out=f"{name}.png")
        elif kind == 1:
            study.add(name, "loads", source="demo:lift", seconds=0.2 + 0.01 * (i % 7), csv=f"{name}.csv", json=f"{name}.json")
        elif kind == 2:
            study.add(name, "render", source="demo:walk", size="64x64", seconds=0.5, out=f"{name}.mp4")
        else:
            study.add(name, "convert", source="demo:lift", seconds=0.1 + 0.01 * (i % 5), out=[f"{name}.mvnx", f"{name}.csv"])
    study.write_list()


def files_of(study):
    """Content by name of all that jobs have written."""
    return {path.name: path.read_bytes() for path in study.folder.glob("job*") if not path.name.startswith("jobs.")}


class Chaos:
    """Runs the shares and kills them."""

    def __init__(self, study, options, job_secs):
        self.study = study
        self.random = random.Random(options.seed)
        self.shares = options.shares
        self.job_secs = job_secs
        # Not among the last jobs: some must be left for the last kill to hit.
        self.moments = sorted(self.random.randrange(options.jobs * 9 // 10) for _ in range(options.kills))
        self.lock = threading.Lock()
        self.running = []
        self.ended_jobs = 0
        self.starts = 0
        self.ends = collections.Counter()
        self.kills = collections.Counter()
        self.timers = []
        self.open = queue.SimpleQueue()
        for share in range(1, self.shares + 1):
            self.open.put(share)

    def run(self, at_once):
        threads = [threading.Thread(target=self.work) for _ in range(at_once)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for timer in self.timers:
            timer.join()

    def work(self):
        while True:
            try:
                share = self.open.get_nowait()
            except queue.Empty:
                return
            if self.do(share) != COMPLETE:
                self.open.put(share)

    def do(self, share):
        process = subprocess.Popen([self.study.program, "batch", "jobs.jsonl", "--shard", f"{share}/{self.shares}", "--jobs", "2",
                                    "--retry", "failed"], cwd=self.study.folder, env=self.study.environment,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        with self.lock:
            self.starts += 1
            self.running.append(process)
        said = ""
        for line in process.stdout:
            said += line
            self.note(line)
        with self.lock:  # a process that has been waited for has no number any more
            code = process.wait()
            self.running.remove(process)
            self.ends[code] += 1
        assert code in (COMPLETE, FAILED, TERMINATED, TERMINATED_AT_ONCE, KILLED), f"share {share} ended with {code}: {said}"
        return code

    def note(self, line):
        """A job has ended: is this a moment to kill?"""
        if not line.startswith(("done", "kept", "failed", "interrupted")):
            return
        with self.lock:
            self.ended_jobs += 1
            while self.moments and self.moments[0] < self.ended_jobs:
                self.moments.pop(0)
                timer = threading.Timer(self.random.uniform(0, 2 * self.job_secs), self.kill)
                self.timers.append(timer)
                timer.start()

    def kill(self):
        with self.lock:
            if not self.running:
                return  # counted below: too few kills
            batch = self.random.choice(self.running).pid
            kind = self.random.choice([signal.SIGTERM, signal.SIGKILL])
            whom = self.random.choice(["batch", "worker", "all"])
            workers = workers_of(batch)
            targets = {"batch": [batch], "worker": workers[:1] or [batch], "all": [batch, *workers]}[whom]
            self.random.shuffle(targets)
            for target in targets:
                try:
                    os.kill(target, kind)
                except ProcessLookupError:
                    pass  # a worker ends with its batch
            self.kills[f"{kind.name} to {whom}"] += 1


def workers_of(batch):
    """Processes that threads of `batch` have started."""
    workers = []
    for children in pathlib.Path(f"/proc/{batch}/task").glob("*/children"):
        try:
            workers += [int(child) for child in children.read_text().split()]
        except OSError:
            pass  # the thread has ended
    return workers


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    for name, value in (("jobs", 60), ("shares", 4), ("kills", 6), ("at_once", 2), ("seed", random.SystemRandom().randrange(10**6))):
        parser.add_argument(f"--{name}", type=int, default=value)
    options = parser.parse_args()
    print(f"seed {options.seed}", flush=True)

    with tempfile.TemporaryDirectory() as top:
        calm, wild = (Study(options.program, pathlib.Path(top) / name) for name in ("calm", "wild"))
        for study in (calm, wild):
            study.folder.mkdir()
            write_study(study, options.jobs)
        began = time.monotonic()
        done = calm.kinescope("batch", "jobs.jsonl", "--jobs", "2")
        assert done.returncode == 0, done.stdout
        calm_secs = time.monotonic() - began

        began = time.monotonic()
        chaos = Chaos(wild, options, calm_secs / options.jobs)
        chaos.run(options.at_once)
        wild_secs = time.monotonic() - began

        ends = ", ".join(f"{count} with {code}" for code, count in sorted(chaos.ends.items()))
        print(f"{options.jobs} jobs in {options.shares} shares, {options.at_once} at a time; without kills {calm_secs:.1f} s, "
              f"with {sum(chaos.kills.values())} kills {wild_secs:.1f} s")
        print("kills: " + ", ".join(f"{count} x {what}" for what, count in sorted(chaos.kills.items())))
        results = wild.results()
        again = sum(result["attempts"] > 1 for result in results.values())
        print(f"{chaos.starts} starts, of which ended {ends}; {chaos.ended_jobs} ends of jobs; {again} jobs counted more than one attempt")
        assert sum(chaos.kills.values()) == options.kills, "too few kills"
        wild.expect_complete()
        expected, found = files_of(calm), files_of(wild)
        assert set(found) == set(expected), set(found) ^ set(expected)
        differing = [name for name in expected if found[name] != expected[name]]
        assert not differing, differing
        left = sorted(path.name for path in wild.folder.iterdir()
                      if path.name not in expected and not path.name.startswith(("jobs.", ".cache", "lift.mvnx")))
        assert not left, left
        print(f"{len(found)} files are equal, {sum(map(len, found.values())) / 1e6:.1f} MB")


main()
