#!/usr/bin/python3
"""Runs clang-tidy on changed files.

tests/tidy_test.py BUILD_FOLDER [--since COMMIT | --all] [--jobs N]
  BUILD_FOLDER: any build with a compile_commands.json (unity builds too); generated headers (ROS messages)
  must exist. Checks the sources and headers of urdf, core, server and render that differ from COMMIT, and new
  ones. Default of COMMIT: the commit where this branch left origin/main, or the last commit but one if it
  has not left origin/main. More than sixty are checked in the batches of the build that have them, which takes about ten
  CPU minutes at most. --all: checks every source in this way.
  .clang-tidy lists the checks. Exit code 1 if there are findings; one line each: file, line, problem.
"""
import argparse
import concurrent.futures
import json
import pathlib
import re
import subprocess
import sys

from changes import names_changed_since, parse_options
from compile_flags import TOP, cpu_seconds, flags_for, read_flags, sources_of

FOLDERS = ("urdf", "core", "server", "render")
MOST_ALONE = 60  # files; each is several seconds, mostly of reading headers
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
    result = subprocess.run(["clang-tidy", "--quiet", *words], capture_output=True, text=True, cwd=TOP)
    found = re.findall(r"^(.+?:\d+):\d+: (?:warning|error): (.+)$", result.stdout, re.MULTILINE)
    lines = {f"{where.replace(f'{TOP}/', '')}: {what.replace(',-warnings-as-errors', '')}"
             for where, what in found}
    if result.returncode != 0 and not lines:
        lines = {f"clang-tidy {' '.join(words[:2])}: {result.stderr.strip()[-300:]}"}
    return lines


def commands_for_changed(build, changed):
    flags = read_flags(build)
    return [[str(file), "--", "-std=c++17", "-Wno-pragma-once-outside-header",
             *(flags_for(flags, file.as_posix()) or []), f"-I{TOP}", "-x", "c++"]
            for file in changed]


def commands_for_batches(build, changed=None):
    """Of all sources, or of batches with one that has changed: a header is checked through the source of its name."""
    database = json.loads((build / "compile_commands.json").read_text())
    not_checked = {TOP / name for name in NOT_CHECKED}
    wanted = None if changed is None else {TOP / file.with_suffix(".cc") for file in changed}
    ours = {entry["file"] for entry in database for source in sources_of(entry)
            if source not in not_checked and any(TOP / folder in source.parents for folder in FOLDERS)
            and (wanted is None or source in wanted)}
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
    if options.all:
        commands = commands_for_batches(build)
    else:
        changed = changed_since(options.since)
        commands = commands_for_changed(build, changed) if len(changed) <= MOST_ALONE else commands_for_batches(build, changed)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        findings = set().union(*pool.map(tidy, commands))
    what = "batches (all sources)" if options.all else f"files or batches of them changed since {options.since[:10]}"
    print(f"{len(commands)} {what}: {len(findings)} findings, {cpu_seconds():.0f} s CPU",
          *sorted(findings), sep="\n")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
