#!/usr/bin/python3
"""Runs clang-tidy on changed files.

tests/tidy_test.py BUILD_FOLDER [--since COMMIT | --all] [--jobs N]
  BUILD_FOLDER: any build with a compile_commands.json (unity builds too); generated headers (ROS messages)
  must exist. Checks the sources and headers of urdf, core, server and render that differ from COMMIT, and new
  ones. Default of COMMIT: the commit where this branch left origin/main, or the last commit but one if it
  has not left origin/main. Those of one folder are checked together, since most of the time goes to the headers of
  libraries; that each source includes what it needs is seen by compiling it alone.
  --all: checks every source, in the batches of the build.
  .clang-tidy lists the checks. Exit code 1 if there are findings; one line each: file, line, problem.
"""
import argparse
import concurrent.futures
import json
import pathlib
import re
import subprocess
import sys
import tempfile

from changes import names_changed_since, parse_options
from compile_flags import TOP, cpu_seconds, flags_for, read_flags, sources_of

FOLDERS = ("urdf", "core", "server", "render")
MOST_TOGETHER = 8  # files, so that both cores have something to do
NOT_CHECKED = {"urdf/skin/make/make_skin.cc"}  # clang-tidy reads CGAL's templates for many minutes


def changed_since(commit):
    """Sources and headers; a header whose source has changed too is checked through that source."""
    files = [pathlib.PurePosixPath(name) for name in sorted(names_changed_since(commit) - NOT_CHECKED)
             if name.startswith(tuple(f"{folder}/" for folder in FOLDERS))]
    sources = [file for file in files if file.suffix == ".cc"]
    return sources + [file for file in files
                      if file.suffix == ".h" and file.with_suffix(".cc") not in sources]


def tidy(words):
    """Set of findings of one run; the end of its error output if clang-tidy failed."""
    result = subprocess.run(["clang-tidy", "--quiet", f"--config-file={TOP}/.clang-tidy", *words], capture_output=True, text=True, cwd=TOP)
    found = re.findall(r"^(.+?:\d+):\d+: (?:warning|error): (.+)$", result.stdout, re.MULTILINE)
    lines = {f"{where.replace(f'{TOP}/', '')}: {what.replace(',-warnings-as-errors', '')}"
             for where, what in found}
    if result.returncode != 0 and not lines:
        lines = {f"clang-tidy {' '.join(words[:2])}: {result.stderr.strip()[-300:]}"}
    return lines


class Batch:
    """Changed files of one folder, which are compiled with the same flags."""

    def __init__(self, files, flags):
        self.files, self._flags = files, ["-std=c++17", "-Wno-pragma-once-outside-header", *flags, f"-I{TOP}", "-x", "c++"]

    def findings(self, folder):
        with tempfile.NamedTemporaryFile("w", suffix=".cc", dir=folder) as together:
            together.write("".join(f'#include "{file}"\n' for file in self.files))
            together.flush()
            found = tidy([together.name, "--", *self._flags])
        # What is found depends on no file beside: two may have the same name for something, and some checks see more together.
        if len(self.files) > 1 and found:
            named = {pathlib.PurePosixPath(line.split(":")[0]).with_suffix("") for line in found}
            again = [file for file in self.files if file.with_suffix("") in named]
            if not again or any("clang-diagnostic-error" in line for line in found):
                again = self.files
            found = set().union(*(Batch([file], self._flags).findings(folder) for file in again))
        return found.union(*map(self._alone, self.files))

    def _alone(self, file):
        result = subprocess.run(["clang++", "-w", "-fsyntax-only", *self._flags, str(TOP / file)], capture_output=True, text=True, cwd=TOP)
        found = re.findall(r"^(.+?:\d+):\d+: (?:fatal )?error: (.+)$", result.stderr, re.MULTILINE)[:1]
        return {f"{where.replace(f'{TOP}/', '')}: on its own: {what}" for where, what in found}


def batches_of(build, changed):
    flags = read_flags(build)
    together = {}
    for file in changed:
        of_file = flags_for(flags, file.as_posix()) or []
        together.setdefault((file.parent, *of_file), []).append(file)
    return [Batch(files[i:i + MOST_TOGETHER], key[1:]) for key, files in together.items()
            for i in range(0, len(files), MOST_TOGETHER)]


def commands_for_all(build):
    """A header is checked through the source of its name."""
    database = json.loads((build / "compile_commands.json").read_text())
    not_checked = {TOP / name for name in NOT_CHECKED}
    ours = {entry["file"] for entry in database for source in sources_of(entry)
            if source not in not_checked and any(TOP / folder in source.parents for folder in FOLDERS)}
    return [["-p", str(build), file] for file in sorted(ours)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=2)
    options = parse_options(parser)
    build = options.build.resolve()
    if not options.all and options.since is None:
        print("no history: no file checked; check all files with tests/tidy_test.py --all")
        return 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool, tempfile.TemporaryDirectory() as folder:
        if options.all:
            commands = commands_for_all(build)
            findings = set().union(*pool.map(tidy, commands))
            what = f"{len(commands)} batches (all sources)"
        else:
            batches = sorted(batches_of(build, changed_since(options.since)), key=lambda batch: -len(batch.files))
            findings = set().union(*pool.map(lambda batch: batch.findings(folder), batches))
            what = f"{sum(len(batch.files) for batch in batches)} files changed since {options.since[:10]}, in {len(batches)} batches"
    print(f"{what}: {len(findings)} findings, {cpu_seconds():.0f} s CPU", *sorted(findings), sep="\n")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
