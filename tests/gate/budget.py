#!/usr/bin/python3
"""The budget of ./check: what its stages, its dearest units and its dearest tests may cost.

tests/budget.json has CPU seconds of one run and, beside them, what the yardstick (tests/gate/yardstick.cc, compiled) took in that run.
Machines differ, and one machine differs from hour to hour: so a price is compared in yardsticks of its own run, never in seconds.

tests/gate/budget.py --accept RUN.json --why TEXT    writes the prices of that run (build/gate/run.json) into tests/budget.json
"""
import argparse
import json
import pathlib
import resource
import statistics
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
BUDGET = TOP / "tests" / "budget.json"
LISTED = 10  # dearest units and tests
KINDS = ("units", "tests")


def cpu_of_children():
    """CPU seconds of all processes that have been waited for."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def yardstick(compiler="clang++"):
    """CPU seconds of the yardstick now, with as many at a time as the gate runs compilers."""
    before = cpu_of_children()
    words = [compiler, "-std=c++17", "-O2", "-c", str(TOP / "tests/gate/yardstick.cc"), "-o", "/dev/null"]
    compilers = [subprocess.Popen(words) for _ in range(2)]
    if any([process.wait() for process in compilers]):
        raise RuntimeError(f"{' '.join(words)} failed: without the yardstick no price can be judged")
    return (cpu_of_children() - before) / 2


class Budget:
    def __init__(self, text):
        values = json.loads(text)
        self._yardstick = values["yardstick_s"]
        self._margin = values["margin"]
        self._most = {"units": values["new_unit_s"], "tests": values["new_test_s"]}
        self._stages = values["stages_s"]
        self._listed = {"units": values["units_s"], "tests": values["tests_s"]}

    def seconds_for(self, stage, yardstick_now):
        """What the stage may cost without the margin, in CPU seconds of this run; None: not in the budget."""
        price = self._stages.get(stage)
        return None if price is None else price * yardstick_now / self._yardstick

    def too_dear_stage(self, stage, cpu, yardstick_now):
        """A sentence, or None."""
        price = self.seconds_for(stage, yardstick_now)
        if price is None:
            return f"the stage '{stage}' has no budget: add it to tests/budget.json"
        if cpu <= self._margin * price:
            return None
        return (f"'{stage}' took {cpu:.0f} CPU s, more than {self._margin} times its budget of {price:.0f} s at today's speed: make it "
                "cheaper, or raise tests/budget.json with a reason")

    def too_dear(self, kind, costs, yardstick_now):
        """Sentences on units or tests: {name: CPU seconds}."""
        speed = yardstick_now / self._yardstick
        found = []
        for name, cpu in sorted(costs.items(), key=lambda item: -item[1]):
            most = max(self._most[kind], self._margin * self._listed[kind].get(name, 0)) * speed
            if cpu > most:
                found.append(f"{kind[:-1]} {name} took {cpu:.0f} CPU s, its limit is {most:.0f} s at today's speed: split it, make it "
                             "cheaper, or list it in tests/budget.json with a reason")
        return found


def read_costs(path):
    """{"units": {name: CPU seconds}, "tests": ...} of a file that tests/gate/cost.cc wrote; of one name the dearest."""
    costs = {kind: {} for kind in KINDS}
    if not path.is_file():
        return costs
    for line in path.read_text().splitlines():
        kind, name, seconds = line.split("\t")
        of_kind = costs[f"{kind}s"]
        of_kind[name] = max(of_kind.get(name, 0), float(seconds))
    return costs


def dearest(costs, count=LISTED):
    return sorted(costs.items(), key=lambda item: -item[1])[:count]


def accept(run, why):
    """The budget with the prices of a run, as text."""
    old = json.loads(BUDGET.read_text())
    speed = statistics.median(run["yardsticks_s"]) / old["yardstick_s"]
    new = dict(old)
    new["stages_s"] = old["stages_s"] | {name: round(cpu / speed) for name, cpu in run["stages_s"].items()}
    for kind in KINDS:
        listed = old[f"{kind}_s"] | run["costs_s"][kind]
        new[f"{kind}_s"] = {name: round(cpu / speed) for name, cpu in dearest(listed)}
    new["reasons"] = [*old["reasons"], why]
    return json.dumps(new, indent=2, ensure_ascii=False) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--accept", metavar="RUN.json", required=True, type=pathlib.Path)
    parser.add_argument("--why", required=True)
    options = parser.parse_args()
    BUDGET.write_text(accept(json.loads(options.accept.read_text()), options.why))
    print(f"{BUDGET}: written; look at the difference")
    return 0


if __name__ == "__main__":
    sys.exit(main())
