#!/usr/bin/python3
"""tests/flaky.sh with tests whose results are known. Usage: flaky_test.py"""
import os
import pathlib
import re
import subprocess
import tempfile

SCRIPT = pathlib.Path(__file__).resolve().with_name("flaky.sh")
TESTS = """
add_test(steady true)
add_test(each_second sh -c "echo >> runs; [ $(($(wc -l < runs) % 2)) = 1 ]")
add_test(skipped sh -c "exit 77")
set_tests_properties(skipped PROPERTIES SKIP_RETURN_CODE 77)
add_test(missing /nowhere/program)
add_test(condition sh -c "nice > nice; nproc > cores")
"""


def run(folder, *words):
    """Exit code and what it prints; what it leaves running is a failure."""
    mark = f"FLAKY_TEST_MARK={os.getpid()}"
    name, value = mark.split("=")
    done = subprocess.run([SCRIPT, *words], env={**os.environ, name: value, "TMPDIR": folder}, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, timeout=120)
    left = []
    for environment in pathlib.Path("/proc").glob("[0-9]*/environ"):
        try:
            if mark.encode() in environment.read_bytes().split(b"\0"):
                left.append((environment.parent / "cmdline").read_text())
        except OSError:
            pass  # it has ended, or is another user's
    assert not left, left
    return done.returncode, done.stdout


def expect(code, text, folder, *words):
    found = run(folder, *words)
    assert found[0] == code and re.search(text, found[1], re.M), f"{words}: {found[0]} instead of {code}, no '{text}': {found[1]}"
    return found[1]


with tempfile.TemporaryDirectory() as name:
    tree = pathlib.Path(name)
    (tree / "CTestTestfile.cmake").write_text(TESTS)
    here = ("--test-dir", name)

    table = expect(1, r"^5 tests; 2 failed at least once$", name, "4", *here)
    rows = {row[-1]: [int(number) for number in row[:3]] for row in map(str.split, table.splitlines()) if row[-2:-1] == ["s"]}
    assert rows["steady"] == [4, 0, 0] and rows["each_second"] == [2, 2, 0], table
    assert rows["skipped"] == [0, 0, 4] and rows["missing"] == [0, 4, 0], table
    logs = re.findall(r"^what failed: (.*)$", table, re.M)
    assert len(logs) == 4 and all("missing" in pathlib.Path(log).read_text() for log in logs), table

    expect(0, r"^1 tests; 0 failed", name, "2", "--random", *here, "-R", "steady")
    expect(0, r"^ +1 +0 +0 .*condition$", name, "1", "--one-core", *here, "-R", "condition")
    assert (tree / "cores").read_text() == "1\n"
    expect(0, "condition", name, "1", "--nice", *here, "-R", "condition")
    assert (tree / "nice").read_text() == "19\n"
    expect(0, "condition", name, "1", "--busy", *here, "-R", "condition")

    expect(2, "No tests were found", name, "1", *here, "-R", "of this name there is none")
    expect(2, "expected how often", name)
    expect(2, "N=0: expected how often", name, "0")
    expect(0, "--one-core", name, "--help")
print("ok")
