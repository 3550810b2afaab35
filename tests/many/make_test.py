#!/usr/bin/python3
"""launch/many/Makefile with GNU make: a failed share has no stamp, and the same command goes on.
Usage: make_test.py PROGRAM"""
import signal
import subprocess
import sys
import tempfile

from trials import RECIPES, Study, id_in, need, share_of

SHARES = 4


def start(study, *words):
    return subprocess.Popen(["make", "-f", RECIPES / "Makefile", "-j2", "-k", f"SHARES={SHARES}", *words], cwd=study.folder,
                            env=study.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def make(study, *words):
    process = start(study, *words)
    said = process.communicate()[0]
    return process.returncode, said


def stamps(study):
    return {path.name: path.stat().st_mtime_ns for path in study.folder.glob("*.stamp")}


need({"make": "make"})
with tempfile.TemporaryDirectory() as folder:
    study = Study(sys.argv[1], folder)
    study.add_pictures(8)
    late = "late"
    study.add(late, "loads", source="late.mvnx", csv="late.csv")
    study.write_list()

    # A failed job: its share has no stamp, the others have.
    code, said = make(study)
    assert code == 2 and "'late.mvnx': file not found" in said, said
    without = f"jobs.{share_of(late, SHARES)}-of-{SHARES}.stamp"
    before = stamps(study)
    assert len(before) == SHARES - 1 and without not in before, before
    code, said = make(study, "check")
    assert code == 2 and "failed      late" in said, said

    # The same command does only that share again.
    study.record("late.mvnx")
    code, said = make(study)
    assert code == 0, said
    after = stamps(study)
    assert after.pop(without) and after == before, (before, after)
    study.expect_complete()

    # A longer list, stopped in the middle.
    waits = id_in(2, SHARES, "waits")
    study.add_waiting(waits)
    study.write_list()
    process = start(study)
    with study.meet(waits):
        process.send_signal(signal.SIGTERM)
        said = process.communicate()[0]
    assert process.returncode != 0, said
    assert study.results()[waits]["state"] == "interrupted", said
    study.let_go(waits)
    code, said = make(study)
    assert code == 0 and f"10 of 10 jobs complete" in said, said
    study.expect_complete()
print("ok")
