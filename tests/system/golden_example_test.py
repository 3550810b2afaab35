#!/usr/bin/python3
"""Runs the jobs of docs/golden_example as a CI server does: in a copy of it, with an empty environment.
Usage: golden_example_test.py PROGRAM"""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
EXAMPLE = pathlib.Path(__file__).resolve().parents[2] / "docs/golden_example"


def run(words, folder):
    return subprocess.run(words, cwd=folder, env={"CI": "true", "PATH": str(PROGRAM.parent)}, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, timeout=120)


for job in ("github.yml", "gitlab.yml"):
    commands = re.findall(r"- (?:run: )?(kinescope .*)", (EXAMPLE / job).read_text())
    assert len(commands) == 1, f"{job}: expected one command, found {commands}"
    with tempfile.TemporaryDirectory() as top:
        folder = pathlib.Path(top) / "copy"
        shutil.copytree(EXAMPLE, folder)
        words = shlex.split(commands[0])
        same = run(words, folder)
        assert same.returncode == 0, f"{job}: {same.stdout}"
        with open(folder / "golden/lift_bend.yaml", "a") as case:
            case.write("hide: cop\n")
        differs = run(words, folder)
        assert differs.returncode == 1, f"{job}: {differs.stdout}"
        assert "centre of pressure: is missing" in differs.stdout, differs.stdout
        for left in ("report.html", "run.json", "lift_bend.actual.png"):
            assert (folder / "golden-run" / left).exists(), f"{job}: no {left}"
        suite = xml.etree.ElementTree.parse(folder / "golden-run/junit.xml").getroot()
        assert suite.get("failures") == "1", xml.etree.ElementTree.tostring(suite)
        accepted = run(["kinescope", "golden", "accept", "golden-run"], folder)
        assert accepted.returncode == 2 and "CI=true" in accepted.stdout, accepted.stdout
print("ok")
