"""A stage of ./check: commands that run one after another, all of them, whichever fails."""
import dataclasses
import os
import re
import subprocess
import sys
import time
import xml.etree.ElementTree

from budget import cpu_of_children

MOST_LINES = 400  # of the output of a command, in which its findings are looked for
LOCK = 9          # of ./check; a compiler that outlives it still holds it, a program that outlives its test does not

FINDING = re.compile(r"FAILED|error|Error|: on its own: |not ok |CMake Error|^\S+:\d+")
COLORS = re.compile(r"\x1b\[[0-9;]*m")


@dataclasses.dataclass
class Command:
    words: list
    what: str = ""                 # in the list of failures; else the command
    env: dict = None               # added to the environment
    builds: bool = False           # holds the lock
    preset: str = None             # whose tests it builds or runs
    results: object = None         # path of the JUnit file that ctest writes
    skipped_code: int = None       # exit code of a check that could not be made here


@dataclasses.dataclass
class Failure:
    stage: str
    what: str


@dataclasses.dataclass
class Stage:
    name: str
    commands: list
    needs: tuple = ()              # names of stages without which it cannot run
    passed: int = 0
    skipped: int = 0
    failures: list = dataclasses.field(default_factory=list)
    cpu: float = 0
    wall: float = 0

    def run(self, environment):
        """@return whether everything passed."""
        began, cpu = time.monotonic(), cpu_of_children()
        for command in self.commands:
            self._run(command, environment)
        self.wall, self.cpu = time.monotonic() - began, cpu_of_children() - cpu
        return not self.failures

    def _run(self, command, environment):
        if command.results is not None:
            command.results.unlink(missing_ok=True)
        lines = []
        code = run_and_print(command, environment, lines)
        tests = read_results(command.results)
        if tests is not None:
            passed, skipped, failed = tests
            self.passed, self.skipped = self.passed + passed, self.skipped + skipped
            self.failures += [Failure(self.name, name) for name in failed]
            if code == 0 or failed:
                return
        elif code == 0:
            self.passed += 1
            return
        elif code == command.skipped_code:
            self.skipped += 1
            return
        what = command.what or " ".join(map(str, command.words))
        self.failures += [Failure(self.name, f"{what}: {line}") for line in findings(lines, code)]


def is_open(descriptor):
    try:
        os.fstat(descriptor)
    except OSError:
        return False
    return True


def run_and_print(command, environment, last_lines):
    """Exit code; prints the output as it comes and keeps its last lines."""
    with subprocess.Popen([str(word) for word in command.words], env=environment | (command.env or {}), stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                          pass_fds=(LOCK,) if command.builds and is_open(LOCK) else ()) as process:
        for line in process.stdout:
            sys.stdout.write(line)
            sys.stdout.flush()
            last_lines.append(line.rstrip())
            del last_lines[:-MOST_LINES]
    return process.returncode


def findings(lines, code):
    """At most three lines that say what is wrong."""
    plain = [COLORS.sub("", line) for line in lines if line.strip()]
    found = [line for line in plain if FINDING.search(line)] or plain[-1:] or [f"ended with exit code {code}"]
    return list(dict.fromkeys(found))[:3]


def read_results(path):
    """(passed, skipped, [names that failed]) of a JUnit file; None without one, as when ctest was stopped."""
    if path is None or not path.is_file():
        return None
    suite = xml.etree.ElementTree.parse(path).getroot()
    states = {}
    for case in suite.iter("testcase"):
        states.setdefault(case.get("status"), []).append(case.get("name"))
    failed = [name for status, names in states.items() if status not in ("run", "notrun", "disabled") for name in names]
    skipped = [name for status in ("notrun", "disabled") for name in states.get(status, [])]
    return len(states.get("run", [])), len(skipped), failed
