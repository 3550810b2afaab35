#!/usr/bin/python3
"""Each pattern by which ./check --since finds the tests of a file that is not compiled (OWNERS in affected.py) matches a test: a
test with a new name is not lost from there.

tests/gate/owners_test.py BUILD_FOLDER...  exit code 77: one of them is not there
"""
import json
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import affected  # noqa: E402

NO_TEST = "$^"  # of files that no test reads


def alternatives(pattern):
    """Those of a pattern, also within brackets: system_test\\.(A|B).* are two."""
    inside = re.search(r"\(([^()]*)\)", pattern)
    if inside is None:
        return pattern.split("|")
    return [alternative for word in inside.group(1).split("|")
            for alternative in alternatives(pattern[:inside.start()] + word + pattern[inside.end():])]


def tests_of(folder):
    listed = subprocess.run(["ctest", "--test-dir", folder, "--show-only=json-v1"], capture_output=True, text=True, check=True).stdout
    return [test["name"] for test in json.loads(listed)["tests"]]


def lost_patterns(tests):
    """Alternatives of OWNERS that match no test."""
    patterns = dict.fromkeys(alternative for _, owner in affected.OWNERS if owner != NO_TEST for alternative in alternatives(owner))
    return [pattern for pattern in patterns if not any(re.fullmatch(pattern, name) for name in tests)]


def main():
    folders = sys.argv[1:]
    missing = [folder for folder in folders if not pathlib.Path(folder, "build.ninja").exists()]
    if missing:
        print(f"skipped: {missing[0]} is not configured (cmake --preset {pathlib.Path(missing[0]).name})")
        return 77
    tests = [name for folder in folders for name in tests_of(folder)]
    lost = lost_patterns(tests)
    for pattern in lost:
        print(f"tests/gate/affected.py: no test is called {pattern}: after a change of its files, --since would leave out what reads them")
    # The check itself: a name that no test has is found.
    if not lost_patterns([name for name in tests if name != "scripts"]):
        print("a pattern without a test is not found")
        return 1
    return 1 if lost else 0


if __name__ == "__main__":
    sys.exit(main())
