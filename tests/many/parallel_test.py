#!/usr/bin/python3
"""launch/many/parallel.sh with GNU parallel: stopped by SIGTERM and SIGHUP, it says what is missing and goes on.
Usage: parallel_test.py PROGRAM"""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile

from trials import RECIPES, Study, id_in, need

SHARES = 4


def start(study, at_once):
    environment = {**study.environment, "PARALLEL": f"--jobs {at_once}"}
    return subprocess.Popen([RECIPES / "parallel.sh", "jobs.jsonl", str(SHARES)], cwd=study.folder, env=environment,
                            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def child_of(process):
    children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    return next(int(child) for child in children if "parallel" in pathlib.Path(f"/proc/{child}/cmdline").read_text())


need({"parallel": "parallel"})
with tempfile.TemporaryDirectory() as folder:
    study = Study(sys.argv[1], folder)
    study.add_pictures(8)
    first, second = id_in(1, SHARES, "first"), id_in(1, SHARES, "second")
    study.add_waiting(first)
    study.write_list()

    # SIGTERM: the share that is under way ends as a whole, and the check says what is missing.
    script = start(study, at_once=2)
    with study.meet(first):
        script.send_signal(signal.SIGTERM)
        said = script.communicate()[0]
    assert script.returncode == 1, said
    assert f"interrupted {first}" in said, said
    assert study.results()[first]["attempts"] == 1
    study.expect_no_leftovers()
    study.let_go(first)

    # SIGHUP: GNU parallel ends with 0 though it has not begun all shares. Ours does not.
    for path in study.folder.glob("jobs.results.*"):
        path.unlink()
    study.add_waiting(second)
    study.write_list()
    script = start(study, at_once=1)
    with study.meet(second) as waiting:
        os.kill(child_of(script), signal.SIGHUP)
        waiting.write(b"no recording")
    said = script.communicate()[0]
    assert script.returncode == 1, said
    assert f"failed      {second}" in said and "missing     picture" in said, said
    study.let_go(second)

    # The same command goes on.
    script = start(study, at_once=2)
    said = script.communicate()[0]
    assert script.returncode == 1 and "9 of 10 jobs complete" in said, said  # what has failed stays so until it is told
    done = study.kinescope("batch", "jobs.jsonl", "--shard", f"1/{SHARES}", "--retry", "failed")
    assert done.returncode == 0, done.stdout
    study.expect_complete()
    rows = (study.folder / "jobs.parallel.log").read_text().splitlines()
    assert len(rows) == 1 + SHARES, rows
print("ok")
