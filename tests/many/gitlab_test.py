#!/usr/bin/python3
"""Shares of golden cases in the jobs of a GitLab pipeline: docs/golden_example/gitlab_shards.yml, run by gitlab-ci-local.
Usage: npm exec --yes --package gitlab-ci-local@4.62.0 -- python3 tests/many/gitlab_test.py PROGRAM"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from trials import SKIPPED

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
EXAMPLE = pathlib.Path(__file__).resolve().parents[2] / "docs/golden_example"
SHARES = 4


def run(words, folder, **more):
    environment = {**os.environ, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}", **more}
    return subprocess.run(words, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def git(folder, *words):
    done = run(["git", "-c", "user.name=test", "-c", "user.email=test@example.org", *words], folder)
    assert done.returncode == 0, done.stdout


def pipeline(folder):
    """Exit code, and the verdicts by picture that the artifacts of all jobs have."""
    shutil.rmtree(folder / ".gitlab-ci-local", ignore_errors=True)
    done = run(["gitlab-ci-local", "--force-shell-executor", "--shell-isolation", "--no-artifacts-to-source"], folder)
    verdicts = {}
    runs = sorted((folder / ".gitlab-ci-local/artifacts").glob("*/golden-run/run.json"))
    assert len(runs) == SHARES, f"{runs}: {done.stdout}"
    for path in runs:
        for verdict in json.loads(path.read_text())["cases"]:
            assert verdict["case"] not in verdicts, f"{verdict['case']} is in two shares"
            verdicts[verdict["case"]] = verdict["outcome"]
    return done, verdicts


def main():
    if not shutil.which("gitlab-ci-local") or not shutil.which("git"):
        print(f"skipped: needs git and gitlab-ci-local; {__doc__.splitlines()[1]}")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as top:
        folder = pathlib.Path(top)
        shutil.copytree(EXAMPLE / "golden", folder / "golden")
        for i in range(8):
            (folder / f"golden/pose{i}.yaml").write_text(f"source: pose:right_elbow={10 * i}\nsize: 64x64\n")
        updated = run(["kinescope", "golden", "update", "golden"], folder, CI="")
        assert updated.returncode == 0, updated.stdout
        shutil.copy(EXAMPLE / "gitlab_shards.yml", folder / ".gitlab-ci.yml")
        git(folder, "init", "--quiet", "--initial-branch=main")
        git(folder, "remote", "add", "origin", "git@example.org:lab/study.git")
        git(folder, "add", ".")
        git(folder, "commit", "--quiet", "--message=Cases")

        done, verdicts = pipeline(folder)
        assert done.returncode == 0, done.stdout
        assert len(verdicts) == 10 and set(verdicts.values()) == {"same"}, verdicts

        with open(folder / "golden/pose3.yaml", "a") as case:
            case.write("hide: body\n")
        git(folder, "commit", "--quiet", "--all", "--message=Without a body")
        done, verdicts = pipeline(folder)
        assert done.returncode != 0, done.stdout
        assert [name for name, outcome in verdicts.items() if outcome != "same"] == ["pose3"], verdicts
    print(f"{SHARES} jobs, {len(verdicts)} pictures, each in one of them")


main()
