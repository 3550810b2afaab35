#!/usr/bin/python3
"""Runs the jobs of docs/golden_example as a CI server does: in a copy of it, with an empty environment.
Usage: golden_example_test.py PROGRAM"""
import collections
import json
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

# The same with several jobs: the server puts the number of each into its command.
SHARED = {
    "github_shards.yml": [{"${{ matrix.shard }}": f"{number}/4"} for number in (1, 2, 3, 4)],
    "gitlab_shards.yml": [{"$CI_NODE_INDEX": str(number), "$CI_NODE_TOTAL": "4"} for number in (1, 2, 3, 4)],
}
for job, values in SHARED.items():
    command = re.search(r"- (?:run: )?(kinescope .*)", (EXAMPLE / job).read_text()).group(1)
    seen = collections.Counter()
    with tempfile.TemporaryDirectory() as top:
        folder = pathlib.Path(top) / "copy"
        shutil.copytree(EXAMPLE, folder)
        for names in values:
            words = command
            for name, value in names.items():
                assert name in words, f"{job}: no {name} in {words}"
                words = words.replace(name, value)
            share = run(shlex.split(words), folder)
            assert share.returncode == 0, f"{job}: {share.stdout}"
            seen.update(case["case"] for case in json.loads((folder / "golden-run/run.json").read_text())["cases"])
    assert seen == {"lift_bend": 1, "no_data": 1}, f"{job}: {seen}"

DOCS = EXAMPLE.parent


def steps_of(document, heading):
    """The commands below a heading, and the exit code that a comment states."""
    block = re.search(rf"## {heading}\n```console\n(.*?)```", document, re.S).group(1)
    for line in block.splitlines():
        code = re.search(r"# exit code (\d)", line)
        yield shlex.split(line.removeprefix("$ "), comments=True), int(code.group(1)) if code else 0


with tempfile.TemporaryDirectory() as folder:
    steps = list(steps_of((DOCS / "golden.md").read_text(), "From an empty folder"))
    assert len(steps) == 4, steps
    for words, code in steps:
        done = subprocess.run(words, cwd=folder, env={"PATH": str(PROGRAM.parent)}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, timeout=120)
        assert done.returncode == code, f"{words}: exit code {done.returncode}, not {code}: {done.stdout}"

table = subprocess.run([sys.executable, DOCS / "golden_keys.py", PROGRAM], stdout=subprocess.PIPE, text=True, check=True).stdout
assert table == (DOCS / "golden_keys.md").read_text(), "run docs/golden_keys.py build/dev/bin/kinescope > docs/golden_keys.md"

# The packages that the image installs are those without a mark.
command = re.search(r"(grep .* packages\.txt) \| xargs", (EXAMPLE / "Dockerfile").read_text()).group(1)
listed = subprocess.run(shlex.split(command), cwd=DOCS.parent, stdout=subprocess.PIPE, text=True, check=True).stdout.split()
expected = [line.split()[0] for line in (DOCS.parent / "packages.txt").read_text().splitlines()
            if line and not line.startswith("#") and "# test" not in line]
assert sorted(listed) == sorted(expected), set(listed) ^ set(expected)
print("ok")
