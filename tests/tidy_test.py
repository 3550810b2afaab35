#!/usr/bin/python3
"""Runs clang-tidy on changed files.

tests/tidy_test.py BUILD_FOLDER [--since COMMIT | --all] [--jobs N]
  BUILD_FOLDER: any build with a compile_commands.json (unity builds too); generated headers (ROS messages)
  must exist. Checks the sources and headers of urdf, core, server and render that differ from COMMIT, and new
  ones, but for those that have passed here before as they are (tests/gate/passed.py). Default of COMMIT: the last commit that is known
  to have passed (tests/changes.py); if none is known, all are checked. Those of one folder are checked together, since most of the time
  goes to the headers of libraries; that each source includes what it needs is seen by compiling it alone.
  --all: checks every source, whatever has passed, in the batches of the build.
  .clang-tidy lists the checks. Exit code 1 if there are findings; one line each: file, line, problem.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from changes import git, names_changed_since, parse_options
from compile_flags import TOP, cpu_seconds, flags_for, read_flags, sources_of
from gate.passed import Passed, key_of

FOLDERS = ("urdf", "core", "server", "render")
FEW, MOST_TOGETHER = 8, 40  # files in a batch: few, so that both cores have something to do, unless there are many batches
NOT_CHECKED = {"urdf/skin/make/make_skin.cc"}  # clang-tidy reads CGAL's templates for many minutes


def files_to_check(since):
    """Sources and headers that differ from that commit, or all; a header whose source is among them is checked through that source."""
    names = names_changed_since(since) if since else set(git("ls-files", "-z"))
    files = [pathlib.PurePosixPath(name) for name in sorted(names - NOT_CHECKED)
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


class Keys:
    """What a file, checked, was: its text, that of its header, the flags, the checks and the checker."""

    def __init__(self):
        version = subprocess.run(["clang-tidy", "--version"], capture_output=True, text=True).stdout
        self._common = key_of(version, (TOP / ".clang-tidy").read_bytes(), pathlib.Path(__file__).read_bytes())

    def of(self, file, flags):
        texts = [path.read_bytes() for path in (TOP / file, (TOP / file).with_suffix(".h")) if path.is_file()]
        return key_of(self._common, file, *[word.replace(str(TOP), "") for word in flags], *texts)


class Batch:
    """Files of one folder, which are compiled with the same flags."""

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


def batches_of(build, files, passed, keys):
    """[(batch, keys of its files)] of the files that have not passed, the largest first."""
    flags = read_flags(build)
    together = {}
    for file in files:
        of_file = flags_for(flags, file.as_posix()) or []
        if keys.of(file, of_file) not in passed:
            together.setdefault((file.parent, *of_file), []).append(file)
    most = FEW if sum(map(len, together.values())) <= 4 * FEW else MOST_TOGETHER
    parts = [(files[i:i + most], key[1:]) for key, files in together.items() for i in range(0, len(files), most)]
    parts.sort(key=lambda part: -len(part[0]))
    return [(Batch(files, flags), [keys.of(file, flags) for file in files]) for files, flags in parts]


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
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    options = parse_options(parser)
    build = options.build.resolve()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool, tempfile.TemporaryDirectory() as folder:
        if options.all:
            commands = commands_for_all(build)
            findings = set().union(*pool.map(tidy, commands))
            what = f"{len(commands)} batches (all sources)"
        else:
            passed = Passed("clang-tidy")
            files = files_to_check(options.since)
            batches = batches_of(build, files, passed, Keys())
            findings = set()
            for found, (_, keys) in zip(pool.map(lambda batch: batch[0].findings(folder), batches), batches):
                findings |= found
                if not found:
                    passed.add(keys)
            since = f"changed since {options.since[:10]}" if options.since else "in all"
            what = f"{len(files)} files {since}, {sum(len(b.files) for b, _ in batches)} of them not passed before, in {len(batches)} batches"
    print(f"{what}: {len(findings)} findings, {cpu_seconds():.0f} s CPU", *sorted(findings), sep="\n")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
