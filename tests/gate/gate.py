#!/usr/bin/python3
"""What ./check does once the packages are there: stages in the order of their price.

A stage that fails stops no other, but for those that need what it builds: one run reports everything. The end of the output has a
table of what the stages took beside their budget (tests/budget.json), and every failure in a line.

tests/gate/gate.py [--quick] [--since REV]
  --quick      only the texts, headers, clang-tidy, and the tests of the libraries
  --since REV  only what the files that differ from REV can have changed; says what it leaves out
"""
import argparse
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys

import affected
import budget
from stage import Command, Failure, Stage

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDER = TOP / "build" / "gate"
PYTHON = "/usr/bin/python3"
MOST_FAILURES = 10
JOBS = len(os.sched_getaffinity(0))
SANITIZED_PROGRAM = "dev-sanitized-program"


def say(text):
    print(f"\033[1m== {text}\033[0m", flush=True)


def build(preset, *targets, is_for_tests=True):
    """Configures if that is needed; goes on after an error, so that one run reports all."""
    script = 'keep_going=yes; . cmake/prepare.sh; build "$@"'
    return Command(["bash", "-c", script, "check", preset, *targets], what=f"building {preset}", builds=True,
                   preset=preset if is_for_tests else None)


def ctest(preset, *words, jobs=JOBS):
    results = FOLDER / f"{preset}.xml"
    return Command(["ctest", "--preset", preset, f"-j{jobs}", "--output-junit", results, *words], what=f"tests of {preset}", results=results,
                   preset=preset)


def all_stages(quick):
    stages = [
        Stage("texts", [
            Command(["tests/format_test.sh"], what="format", skipped_code=77),
            Command([PYTHON, "tests/layers_test.py"], what="layers"),
            Command([PYTHON, "tests/names_test.py"], what="names"),
            Command([PYTHON, "tests/module_abi_test.py"], what="ABI of the modules"),
            Command([PYTHON, "-B", "tests/gate/gate_test.py"], what="the gate itself"),
            Command(["node", "--test", "tests/browser/types.test.mjs"], what="types of the page"),
        ]),
        Stage("headers and clang-tidy", [
            build("asan", "kinescope_ros_messages", is_for_tests=False),
            Command([PYTHON, "tests/headers_test.py", "build/asan"], what="headers"),
            Command([PYTHON, "tests/tidy_test.py", "build/asan"], what="clang-tidy"),
        ]),
        Stage("build sanitized", [build("asan")]),
        Stage("test libraries", [ctest("asan")], needs=("build sanitized",)),
    ]
    if quick:
        return stages
    return stages + [
        Stage("build program", [build("dev")]),
        Stage("test program", [ctest("dev", jobs=JOBS + 1)],  # most of them wait more than they compute
              needs=("build program",)),
        Stage("test sanitized program", [ctest(SANITIZED_PROGRAM)], needs=("build sanitized", "build program")),
        Stage("build threads", [build("tsan", "threads_test")]),
        Stage("test threads", [ctest("tsan", "-R", "threads_test")], needs=("build threads",)),
    ]


class Run:
    def __init__(self, stages, budget_of_gate):
        self._stages, self._budget = stages, budget_of_gate
        self._costs_path = FOLDER / "costs"
        self._yardsticks = []          # before the first stage and after each
        self._done, self._left_out = [], []

    def go(self):
        shutil.rmtree(FOLDER, ignore_errors=True)
        FOLDER.mkdir(parents=True)
        environment = os.environ | {"KINESCOPE_COSTS": str(self._costs_path)}
        broken = set()
        self._yardsticks.append(budget.yardstick())
        for stage in self._stages:
            if broken.intersection(stage.needs):
                self._left_out.append(stage)
                broken.add(stage.name)
                continue
            say(stage.name)
            if not stage.run(environment):
                broken.add(stage.name)
            self._yardsticks.append(budget.yardstick())
            self._done.append(stage)

    @property
    def _yardstick(self):
        return statistics.median(self._yardsticks)

    def _too_dear(self, costs):
        """Of each stage by the yardsticks beside it; of units and tests, whose time is not known, by that of the run."""
        found = [self._budget.too_dear_stage(stage.name, stage.cpu, sum(self._yardsticks[i:i + 2]) / 2)
                 for i, stage in enumerate(self._done)]
        found = [sentence for sentence in found if sentence]
        for kind in budget.KINDS:
            found += self._budget.too_dear(kind, costs[kind], self._yardstick)
        return [Failure("budget", sentence) for sentence in found]

    def report(self):
        """@return the exit code."""
        costs = budget.read_costs(self._costs_path)
        record = {"yardsticks_s": self._yardsticks, "stages_s": {stage.name: stage.cpu for stage in self._done},
                  "wall_s": {stage.name: stage.wall for stage in self._done}, "costs_s": costs}
        (FOLDER / "run.json").write_text(json.dumps(record, indent=1))
        for kind in budget.KINDS:
            if costs[kind]:
                say(f"dearest {kind}, CPU s")
                print(*(f"{seconds:8.1f}  {name}" for name, seconds in budget.dearest(costs[kind])), sep="\n")
        self._print_table()
        too_dear = self._too_dear(costs)
        failures = [failure for stage in self._done for failure in stage.failures] + too_dear
        for failure in failures[:MOST_FAILURES]:
            print(f"FAILED {failure.stage}: {failure.what}"[:240])
        if len(failures) > MOST_FAILURES:
            print(f"FAILED {len(failures) - MOST_FAILURES} more, see above")
        for stage in self._left_out:
            print(f"not run: {stage.name} ({', '.join(stage.needs)} failed)")
        passed, skipped = sum(stage.passed for stage in self._done), sum(stage.skipped for stage in self._done)
        print(f"check: {passed} passed, {len(failures)} failed, {skipped} skipped", flush=True)
        return 1 if failures else 0

    def _print_table(self):
        say(f"what it took; yardstick {self._yardstick:.2f} CPU s, {min(self._yardsticks):.2f} to {max(self._yardsticks):.2f}")
        print(f"{'stage':26} {'wall s':>8} {'CPU s':>8} {'budget':>8}   (budget: CPU s at today's speed)")
        for i, stage in enumerate(self._done):
            may = self._budget.seconds_for(stage.name, sum(self._yardsticks[i:i + 2]) / 2)
            print(f"{stage.name:26} {stage.wall:8.0f} {stage.cpu:8.0f} {'-' if may is None else format(may, '8.0f'):>8}")
        print(f"{'all':26} {sum(s.wall for s in self._done):8.0f} {sum(s.cpu for s in self._done):8.0f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--since", metavar="REV")
    options = parser.parse_args()
    os.chdir(TOP)
    stages = all_stages(options.quick)
    if options.since is not None:
        try:
            stages = affected.narrowed(stages, affected.Change(options.since))
        except affected.UnknownRevision as error:
            print(f"check: {error}", file=sys.stderr)
            return 2
    run = Run(stages, budget.Budget(budget.BUDGET.read_text()))
    run.go()
    return run.report()


if __name__ == "__main__":
    sys.exit(main())
