#!/usr/bin/python3
"""Each rule of the gate stops a fault that was made on purpose. tests/gate/gate_test.py"""
import contextlib
import io
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import affected
import budget
import changes
import gate
import passed
import stage
from stage import Command, Stage

BUDGET = json.dumps({"yardstick_s": 1.0, "margin": 2, "new_unit_s": 40, "new_test_s": 20, "stages_s": {"one": 10, "two": 10},
                     "units_s": {"dear.o": 60}, "tests_s": {}, "reasons": []})


def shell(text, **words):
    return Command(["sh", "-c", text], **words)


class Rooms(unittest.TestCase):
    """Each test has a folder, and a gate whose yardstick takes a second."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self._former = gate.FOLDER, budget.yardstick
        gate.FOLDER, budget.yardstick = self.folder / "gate", lambda: 1.0
        self.addCleanup(self._restore)

    def _restore(self):
        gate.FOLDER, budget.yardstick = self._former

    def run_stages(self, *stages):
        """(exit code, lines of the output)"""
        with contextlib.redirect_stdout(io.StringIO()) as out:
            run = gate.Run(stages, budget.Budget(BUDGET))
            run.go()
            code = run.report()
        return code, out.getvalue().splitlines()


class Stages(Rooms):
    def test_all_run_whichever_fails_and_all_failures_are_at_the_end(self):
        code, lines = self.run_stages(Stage("one", [shell("echo a.cc:1: error: bad; exit 1", what="first"), shell("exit 3", what="second")]),
                                      Stage("two", [shell("echo fine")]))
        self.assertEqual(code, 1)
        self.assertEqual(lines[-3:], ["FAILED one: first: a.cc:1: error: bad", "FAILED one: second: ended with exit code 3",
                                      "check: 1 passed, 2 failed, 0 skipped"])

    def test_what_needs_a_failed_stage_is_named_and_not_run(self):
        code, lines = self.run_stages(Stage("one", [shell("exit 1")]), Stage("two", [shell("echo RUN")], needs=("one",)))
        self.assertEqual(code, 1)
        self.assertNotIn("RUN", lines)
        self.assertIn("not run: two (one failed)", lines)

    def test_more_than_ten_failures_are_counted(self):
        code, lines = self.run_stages(Stage("one", [shell("exit 1", what=f"check {i}") for i in range(13)]))
        self.assertEqual(code, 1)
        self.assertIn("FAILED 3 more, see above", lines)
        self.assertEqual(sum(line.startswith("FAILED one") for line in lines), 10)

    def test_a_check_that_cannot_be_made_here_is_skipped(self):
        code, lines = self.run_stages(Stage("one", [shell("exit 77", skipped_code=77)]))
        self.assertEqual((code, lines[-1]), (0, "check: 0 passed, 0 failed, 1 skipped"))

    def test_failed_tests_are_named(self):
        results = self.folder / "results.xml"
        junit = ('<testsuite><testcase name="A.B" status="run"/><testcase name="C.D" status="fail"/>'
                 '<testcase name="E.F" status="notrun"/></testsuite>')
        code, lines = self.run_stages(Stage("one", [shell(f"echo '{junit}' > {results}; exit 8", results=results)]))
        self.assertEqual(code, 1)
        self.assertEqual(lines[-2:], ["FAILED one: C.D", "check: 1 passed, 1 failed, 1 skipped"])

    def test_results_of_an_earlier_run_are_not_read(self):
        results = self.folder / "results.xml"
        results.write_text('<testsuite><testcase name="A.B" status="run"/></testsuite>')
        code, _ = self.run_stages(Stage("one", [shell("exit 1", results=results)]))
        self.assertEqual(code, 1)


class Prices(Rooms):
    def test_a_stage_of_more_than_twice_its_budget_fails(self):
        burn = Command([sys.executable, "-c", "import time\nwhile time.process_time() < 0.3: pass"])
        dear = json.loads(BUDGET) | {"stages_s": {"one": 0.1}}
        with contextlib.redirect_stdout(io.StringIO()) as out:
            run = gate.Run([Stage("one", [burn])], budget.Budget(json.dumps(dear)))
            run.go()
            self.assertEqual(run.report(), 1)
        self.assertRegex(out.getvalue(), "FAILED budget: 'one' took .* more than 2 times its budget")

    def test_a_slow_machine_fails_nothing(self):
        prices = budget.Budget(BUDGET)
        self.assertIsNotNone(prices.too_dear_stage("one", 30, 1.0))
        self.assertIsNone(prices.too_dear_stage("one", 30, 1.6))

    def test_a_stage_without_a_budget_fails(self):
        self.assertIn("no budget", budget.Budget(BUDGET).too_dear_stage("three", 1, 1.0))

    def test_a_new_unit_or_test_must_not_be_dear(self):
        prices = budget.Budget(BUDGET)
        self.assertEqual(len(prices.too_dear("units", {"new.o": 41, "cheap.o": 39}, 1.0)), 1)
        self.assertEqual(len(prices.too_dear("tests", {"new": 21, "cheap": 19}, 1.0)), 1)
        self.assertEqual(prices.too_dear("units", {"dear.o": 110}, 1.0), [])  # it is listed
        self.assertEqual(len(prices.too_dear("units", {"dear.o": 121}, 1.0)), 1)

    def test_an_accepted_run_is_counted_at_the_speed_of_the_budget(self):
        former = budget.BUDGET
        self.addCleanup(setattr, budget, "BUDGET", former)
        budget.BUDGET = self.folder / "budget.json"
        budget.BUDGET.write_text(BUDGET)
        run = {"yardsticks_s": [2.0, 2.0], "stages_s": {"one": 40}, "costs_s": {"units": {"new.o": 100}, "tests": {}}}
        new = json.loads(budget.accept(run, "one does more"))
        self.assertEqual((new["stages_s"], new["units_s"]["new.o"], new["reasons"]), ({"one": 20, "two": 10}, 50, ["one does more"]))

    def test_the_meter_counts_what_a_command_and_its_children_take(self):
        meter, costs = self.folder / "cost", self.folder / "costs"
        source = pathlib.Path(gate.__file__).parent / "cost.cc"
        subprocess.run(["clang++", "-std=c++17", source, "-o", meter], check=True)
        burn = f"({sys.executable} -c 'import time\nwhile time.process_time() < 0.2: pass') & wait; exit 5"
        result = subprocess.run([meter, "test:name", "sh", "-c", burn], env=os.environ | {"KINESCOPE_COSTS": str(costs)})
        self.assertEqual(result.returncode, 5)
        self.assertGreater(budget.read_costs(costs)["tests"]["name"], 0.19)


class Memory(Rooms):
    def test_what_has_passed_is_known_in_the_next_run_and_changes_are_not(self):
        former = os.environ.get("XDG_CACHE_HOME")
        os.environ["XDG_CACHE_HOME"] = str(self.folder)
        self.addCleanup(lambda: os.environ.__setitem__("XDG_CACHE_HOME", former) if former else os.environ.pop("XDG_CACHE_HOME"))
        passed.Passed("check").add([passed.key_of("a.cc", b"text")])
        self.assertIn(passed.key_of("a.cc", b"text"), passed.Passed("check"))
        self.assertNotIn(passed.key_of("a.cc", b"text!"), passed.Passed("check"))
        self.assertNotIn(passed.key_of("a.cc", b"text"), passed.Passed("another"))

    def test_texts_do_not_run_into_each_other(self):
        self.assertNotEqual(passed.key_of("ab", "c"), passed.key_of("a", "bc"))


class Since(unittest.TestCase):
    def test_whole_programs_are_named_once(self):
        every = ["a.one", "a.two", "b.one", "b.two", "documents"]
        self.assertEqual(affected.pattern_of(["a.one", "a.two", "b.two", "documents"], every), r"^(a(\..*)?|b\.two|documents(\..*)?)$")

    def test_an_unknown_revision_is_an_error(self):
        with self.assertRaisesRegex(affected.UnknownRevision, "--since=nowhere: unknown revision"):
            affected.Change("nowhere")


class SinceInABuild(Rooms):
    """A project of two rooms, each with a test, and a script that starts a program."""

    FILES = {
        "CMakeLists.txt": """cmake_minimum_required(VERSION 3.25)
project(rooms LANGUAGES C)
enable_testing()
foreach(room one two)
  add_executable(${room}_test ${room}.c)
  add_test(NAME ${room}_test.all COMMAND ${room}_test)
endforeach()
add_test(NAME script COMMAND sh ${PROJECT_SOURCE_DIR}/script.sh $<TARGET_FILE:one_test>)
""",
        "CMakePresets.json": """{"version": 6, "configurePresets": [{"name": "dev", "generator": "Ninja", "binaryDir": "${sourceDir}/build/dev"}],
 "testPresets": [{"name": "dev", "configurePreset": "dev"}]}""",
        "one.c": '#include "one.h"\nint main(void) { return kOne - 1; }\n', "one.h": "enum { kOne = 1 };\n",
        "two.c": "int main(void) { return 0; }\n", "script.sh": '"$1"\n', ".gitignore": "build\n",
    }

    def setUp(self):
        super().setUp()
        for name, text in self.FILES.items():
            (self.folder / name).write_text(text)
        for words in (["git", "init", "-q"], ["git", "add", "."],
                      ["git", "-c", "user.name=a", "-c", "user.email=a@b", "commit", "-qm", "rooms"],
                      ["cmake", "--preset", "dev"], ["cmake", "--build", "build/dev"]):
            subprocess.run(words, cwd=self.folder, check=True, stdout=subprocess.DEVNULL)
        for module in (affected, changes):
            self.addCleanup(setattr, module, "TOP", module.TOP)
            module.TOP = self.folder.resolve()

    def affected_by(self, name, text):
        (self.folder / name).write_text(text)
        build = affected.Build(affected.TOP / "build" / "dev")
        return affected.affected_tests(affected.Change("HEAD"), build, "dev")[0]

    def test_a_header_affects_the_tests_whose_programs_include_it_and_scripts_that_start_them(self):
        self.assertEqual(self.affected_by("one.h", "enum { kOne = 2 };\n"), ["one_test.all", "script"])

    def test_a_source_of_the_other_room_affects_its_test_alone(self):
        self.assertEqual(self.affected_by("two.c", "int main(void) { return 1; }\n"), ["two_test.all"])

    def test_a_script_affects_the_tests_that_name_it(self):
        self.assertEqual(self.affected_by("script.sh", "exit 1\n"), ["script"])

    def test_a_file_that_nothing_knows_affects_everything(self):
        self.affected_by("table.dat", "1 2 3\n")
        self.assertEqual(affected.Change("HEAD").for_everything, ["table.dat"])


class Findings(unittest.TestCase):
    def test_are_the_lines_that_say_what_is_wrong(self):
        self.assertEqual(stage.findings(["all", "x.cc:3: long line", "bye"], 1), ["x.cc:3: long line"])
        self.assertEqual(stage.findings(["reading", "no network"], 1), ["no network"])
        self.assertEqual(stage.findings([], 9), ["ended with exit code 9"])


if __name__ == "__main__":
    unittest.main()
