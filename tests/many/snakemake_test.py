#!/usr/bin/python3
"""launch/many/Snakefile with Snakemake: from raw captures to clips, loads, motion and a report; killed (signal 9), it goes on.
Usage: snakemake_test.py PROGRAM"""
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

from trials import RECIPES, Study, need


def capture(study, name):
    """Half a second of a suit's datagrams."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        address = f"udp://127.0.0.1:{probe.getsockname()[1]}"
    suit = subprocess.Popen([study.program, "stream", "demo:lift", "--to", address], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        done = study.kinescope("record", address, "--out", f"captures/{name}.pcap", "--seconds", "0.5")
        assert done.returncode == 0, done.stdout
    finally:
        suit.kill()
        suit.wait()


def start(study, *words):
    return subprocess.Popen(["snakemake", "--cores", "2", "--keep-going", *words], cwd=study.folder, env=study.environment,
                            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def snakemake(study, *words):
    process = start(study, *words)
    said = process.communicate()[0]
    return process.returncode, said


def files(study):
    return {str(path.relative_to(study.folder)): path.stat().st_mtime_ns
            for folder in ("clips", "loads", "motion") for path in (study.folder / folder).iterdir()}


need({"snakemake": "snakemake"})
with tempfile.TemporaryDirectory() as folder:
    study = Study(sys.argv[1], folder)
    (study.folder / "captures").mkdir()
    shutil.copy(RECIPES / "Snakefile", folder)
    for name in ("S1_lift_1", "S1_lift_2"):
        capture(study, name)

    code, said = snakemake(study)
    assert code == 0, said
    assert "6 of 6 jobs complete" in (study.folder / "complete.txt").read_text(), said
    page, table = (study.folder / "study.html").read_text(), (study.folder / "study.csv").read_text()
    assert "2 trials of 1 person in 1 condition" in page, page[:2000]
    assert "S1_lift_2" in table, table
    first = files(study)
    for name in ("clips/S1_lift_1.mp4", "loads/S1_lift_2.json", "motion/S1_lift_1.mvnx"):
        assert name in first, first
    code, said = snakemake(study)
    assert code == 0 and "Nothing to be done" in said, said

    # Another capture: what is there stays.
    capture(study, "S2_lift_1")
    code, said = snakemake(study)
    assert code == 0, said
    second = files(study)
    assert "9 of 9 jobs complete" in (study.folder / "complete.txt").read_text()
    assert "S2_lift_1" in (study.folder / "study.csv").read_text()
    assert {name: second[name] for name in first} == first, "done again"

    # Another option: only what it decides is made again.
    recipe = study.folder / "Snakefile"
    recipe.write_text(recipe.read_text().replace('LOADS = "', 'LOADS = "--mass 80 '))
    code, said = snakemake(study)
    assert code == 0, said
    third = files(study)
    assert {name for name in third if third[name] != second[name]} == {name for name in third if name.startswith("loads/")}, said

    # Killed: the shares that it has started end by themselves. Then it refuses to go on until it is told to.
    capture(study, "S3_lift_1")
    process = start(study)
    while not any("batch" in words for words in study.processes().values()):
        assert process.poll() is None, process.communicate()[0]
    process.send_signal(signal.SIGKILL)
    process.communicate()
    while study.processes():
        time.sleep(0.05)
    code, said = snakemake(study)
    assert code == 1 and ("--unlock" in said or "--rerun-incomplete" in said), said
    code, said = snakemake(study, "--unlock")
    assert code == 0, said
    code, said = snakemake(study, "--rerun-incomplete")
    assert code == 0, said
    assert "12 of 12 jobs complete" in (study.folder / "complete.txt").read_text()
    study.expect_no_leftovers()
print("ok")
