#!/usr/bin/python3
"""Checks that every header includes what it needs: it compiles on its own, and it includes the standard header
of each std:: name in it, instead of relying on another header.

tests/headers_test.py BUILD_FOLDER [--since COMMIT | --all] [--jobs N] [--tests] [--only PART_OF_A_PATH]
  BUILD_FOLDER: any build with a compile_commands.json (unity builds too), for the include paths and
  definitions of each folder; generated headers (ROS messages) must exist. Compiles the headers that differ
  from COMMIT, and those that include, directly or not, one that has lost an include or a declaration since; but for those that have
  passed here before as they are (tests/gate/passed.py). The sources of tests/bench are looked at in the same way. Default of COMMIT: the last commit that is known to have passed
  (tests/changes.py); if none is known, all are compiled. --all: compiles all, whatever has passed, which takes five CPU minutes. --tests: also the headers of tests/, which is slow because of GoogleTest.
  Exit code 1 if an include is missing; one line per finding: header, line, problem.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from changes import has_lost_a_name, names_changed_since, parse_options
from compile_flags import INCLUDE, TOP, cpu_seconds, flags_for, read_flags
from gate.passed import Passed, key_of

FOLDERS = ("urdf", "core", "server", "render")
BENCHES = "tests/bench"  # ./check builds none of them

# Header -> std:: names that need it. If several headers are listed, a finding names the first.
STANDARD = {
    "algorithm": "all_of any_of none_of clamp copy fill find find_if max max_element min min_element "
                 "minmax_element nth_element remove_if reverse sort stable_sort transform unique "
                 "upper_bound lower_bound",
    "array": "array",
    "atomic": "atomic",
    "bitset": "bitset",
    "charconv": "from_chars to_chars",
    "chrono": "chrono",
    "cmath": "abs acos asin atan atan2 ceil cos exp floor fmod hypot isfinite isinf isnan llround log "
             "lround pow round sin sqrt tan",
    "condition_variable": "condition_variable",
    "cstddef": "byte nullptr_t ptrdiff_t size_t",
    "cstdint": "int8_t int16_t int32_t int64_t uint8_t uint16_t uint32_t uint64_t uintmax_t "
               "uintptr_t intptr_t",
    "cstdio": "FILE fopen fprintf snprintf",
    "cstring": "memcmp memcpy memset strlen",
    "deque": "deque",
    "exception": "exception exception_ptr current_exception rethrow_exception terminate",
    "filesystem": "filesystem",
    "functional": "function greater hash less reference_wrapper ref cref",
    "future": "future promise shared_future async packaged_task",
    "initializer_list": "initializer_list",
    "iosfwd ostream istream iostream sstream fstream": "ostream istream",
    "limits": "numeric_limits",
    "list": "list",
    "map": "map multimap",
    "memory": "enable_shared_from_this make_shared make_unique shared_ptr unique_ptr weak_ptr",
    "mutex": "lock_guard mutex recursive_mutex once_flag scoped_lock unique_lock call_once",
    "numeric": "accumulate iota",
    "optional": "make_optional nullopt optional",
    "queue": "priority_queue queue",
    "random": "mt19937 mt19937_64 random_device",
    "set": "multiset set",
    "shared_mutex": "shared_lock shared_mutex",
    "sstream": "istringstream ostringstream stringstream",
    "fstream": "ifstream ofstream fstream",
    "stdexcept": "invalid_argument logic_error out_of_range runtime_error",
    "string": "getline stod stoi string to_string",
    "string_view": "string_view",
    "system_error": "error_code errc system_error",
    "thread": "thread this_thread",
    "tuple": "forward_as_tuple make_tuple tie tuple",
    "type_traits": "conditional_t decay_t enable_if_t false_type integral_constant is_base_of_v "
                   "is_convertible_v is_same_v is_trivially_copyable_v remove_cv_t true_type "
                   "underlying_type_t void_t",
    "unordered_map": "unordered_map",
    "unordered_set": "unordered_set",
    "utility": "declval exchange forward move pair swap make_pair",
    "variant": "get_if holds_alternative monostate variant visit",
    "vector": "vector",
}
HEADERS_OF = {name: headers.split() for headers, names in STANDARD.items() for name in names.split()}
# Names that other headers provide too.
ALSO_IN = {
    "size_t": ["cstdint", "cstring", "array", "string", "string_view", "vector"],
    "move": ["memory", "algorithm"], "forward": ["memory"], "swap": ["memory", "algorithm"],
    "exchange": [], "pair": ["map"],
    "string": ["sstream"], "getline": ["istream", "sstream"],
    "initializer_list": ["vector", "string", "map", "set"],
}

NO_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.DOTALL)


def blank(match):
    """The same number of lines, without the text."""
    return " " + "\n" * match.group().count("\n")


def missing_by_text(name, text):
    """std:: names whose header is not included: one line per missing header."""
    included = {m.group(2) for m in map(INCLUDE.match, text.splitlines()) if m}
    code = NO_CODE.sub(blank, re.sub(r"(?<=\d)'(?=\d)", "", text))
    findings = {}
    for number, line in enumerate(code.splitlines(), 1):
        for used in re.findall(r"(?<![\w:])(?:::)?std::(\w+)", line):
            headers = HEADERS_OF.get(used, [])
            if headers and not included.intersection(headers + ALSO_IN.get(used, [])):
                findings.setdefault(headers[0],
                                    f"{name}:{number}: std::{used} without #include <{headers[0]}>")
    return list(findings.values())


class Closures:
    """All includes of a header, directly and through headers of the project."""

    def __init__(self):
        self._includes = {}
        self._closures = {}

    def _of(self, name):
        if name not in self._includes:
            lines = (TOP / name).read_text().splitlines() if (TOP / name).is_file() else []
            self._includes[name] = {m.group(2) for m in map(INCLUDE.match, lines) if m}
        return self._includes[name]

    def __getitem__(self, name):
        if name not in self._closures:
            found, open_ends = set(), [name]
            while open_ends:
                for include in self._of(open_ends.pop()) - found:
                    found.add(include)
                    open_ends.append(include)
            self._closures[name] = found
        return self._closures[name]


CLANG = ["clang++", "-std=c++17", "-w", "-fsyntax-only"]

# Compile time of an include, in units of one standard header; libraries that are not listed count as one.
PRICES = {"Eigen/": 40, "nlohmann/json.hpp": 30, "boost/": 60, "CLI/": 60, "yaml-cpp/": 30, "ros/": 20,
          "image_transport/": 40, "tf2": 20, "vtk": 5, "gtest/": 40, "gmock/": 40, "fmt/": 15}


def price(includes):
    return sum(next((p for start, p in PRICES.items() if include.startswith(start)), 1)
               for include in includes)


def choose_hubs(names, closures):
    """Headers of the project and of Eigen that are worth precompiling, because many headers include them,
    directly or not. Precompiling changes only the time, because each header is also compiled on its own.
    Cheapest first."""
    prices = {name: price(closures[name]) for name in names}
    prices.update({"Eigen/Core": 30, "Eigen/Geometry": 40})
    users = {hub: [name for name in names if hub in closures[name] and name not in closures[hub]]
             for hub in prices}
    best = dict.fromkeys(names, 0)
    hubs = []
    while True:
        gains = {hub: sum(max(0, prices[hub] - best[name]) for name in users[hub]) - prices[hub] - 40
                 for hub in prices if hub not in hubs}
        hub = max(gains, key=gains.get, default=None)
        if hub is None or gains[hub] <= 0:
            return sorted(hubs, key=prices.get)
        hubs.append(hub)
        for name in users[hub]:
            best[name] = max(best[name], prices[hub])


class Precompiled:
    """Hubs, each precompiled separately into `folder`: clang 14 crashes on some that build on others."""

    def __init__(self, names, closures, flags, folder):
        self._closures = closures
        self._files = {}
        for hub in choose_hubs(names, closures):
            own = flags_for(flags, hub) if hub in names else self._eigen_flags(flags)
            paths = [word for i, word in enumerate(own or []) if word.startswith("-I") or
                     word == "-isystem" or own[i - 1] == "-isystem"]
            out = folder / (re.sub(r"\W", "_", hub) + ".pch")
            text = f'#include "{hub}"\n' if hub in names else f"#include <{hub}>\n"
            result = subprocess.run(
                [*CLANG[:-1], *paths, f"-I{TOP}", "-x", "c++-header", "-", "-o",
                 str(out)], input=text, capture_output=True, text=True, cwd=TOP)
            if result.returncode == 0:  # else the error is reported when the header is compiled on its own
                self._files[hub] = out

    @staticmethod
    def _eigen_flags(flags):
        return next((f for f in flags.values() if any("eigen" in word for word in f)), None)

    def words_for(self, name):
        """Options with which clang loads the largest hub that `name` includes."""
        for hub in reversed(self._files):
            if hub in self._closures[name] and name not in self._closures[hub]:
                return ["-include-pch", str(self._files[hub])]
        return []

    def __len__(self):
        return len(self._files)


def compile_alone(name, flags, begin):
    """List of problems of the header on its own; [] if it compiles."""
    if flags is None:
        return [f"{name}:1: no source of its folder, or of a folder above it, is in the build"]
    for words in (begin, []) if begin else ([],):  # second try without a precompiled hub
        result = subprocess.run(
            [*CLANG, *flags, *words, "-ferror-limit=1", "-fno-caret-diagnostics", "-x", "c++",
             str(TOP / name)], capture_output=True, text=True, cwd=TOP)
        if result.returncode == 0:
            return []
    errors = [line for line in result.stderr.splitlines() if "error:" in line]
    first = (errors or [f"{TOP / name}:1: error: does not compile"])[0]
    where, what = re.split(r": (?:fatal )?error: ", first, maxsplit=1)
    where = where.replace(f"{TOP}/", "")
    return [f"{where}: on its own: {what}" + ("" if where.startswith(name) else f" (in {name})")]


def affected_by(changed, since, names, closures):
    """What a header found in another one is missing only if that has lost something."""
    poorer = {name for name in changed if name.endswith(".h") and has_lost_a_name(since, name)}
    return [name for name in names if name in changed or poorer & closures[name]]


class Keys:
    """What a header, compiled, was: its text and flags, and of the headers that it includes the lines that begin at the left, the
    includes and declarations that it may rely on."""

    def __init__(self, closures, flags):
        self._closures, self._flags, self._lines = closures, flags, {}
        version = subprocess.run([CLANG[0], "--version"], capture_output=True, text=True).stdout
        self._common = key_of(version, *CLANG)

    def _lines_at_left(self, name):
        if name not in self._lines:
            path = TOP / name
            self._lines[name] = "\n".join(re.findall(r"^[A-Za-z#].*", path.read_text(), re.MULTILINE)) if path.is_file() else name
        return self._lines[name]

    def of(self, name):
        flags = [word.replace(str(TOP), "") for word in flags_for(self._flags, name) or []]
        return key_of(self._common, name, *flags, (TOP / name).read_text(), *map(self._lines_at_left, sorted(self._closures[name])))


def compile_all(names, closures, flags, jobs):
    """{name: findings}"""
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        hubs = Precompiled(names, closures, flags, pathlib.Path(folder))
        results = pool.map(
            lambda name: compile_alone(name, flags_for(flags, name), hubs.words_for(name)), names)
        return dict(zip(names, results))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--tests", action="store_true")
    parser.add_argument("--only", default="")
    options = parse_options(parser)
    folders = FOLDERS + ("tests",)
    headers = sorted(path.relative_to(TOP).as_posix() for folder in folders
                     for path in (TOP / folder).rglob("*.h") if "node_modules" not in path.parts)
    headers = [name for name in headers if options.only in name]
    findings = [finding for name in headers
                for finding in missing_by_text(name, (TOP / name).read_text())]
    alone = [name for name in headers if options.tests or not name.startswith("tests/")]
    alone += sorted(path.relative_to(TOP).as_posix() for path in (TOP / BENCHES).glob("*.cc") if options.only in path.as_posix())
    closures, flags = Closures(), read_flags(options.build.resolve())
    flags[BENCHES] = [word for of_folder in flags.values() for word in of_folder]  # they are no part of a sanitized build
    keys, passed = Keys(closures, flags), Passed("headers")
    if not options.all:
        if options.since is not None:
            alone = affected_by(names_changed_since(options.since), options.since, alone, closures)
        alone = [name for name in alone if keys.of(name) not in passed]
    found = compile_all(alone, closures, flags, options.jobs)
    passed.add(keys.of(name) for name in alone if not found[name])
    findings += [finding for of_header in found.values() for finding in of_header]
    print(f"{len(headers)} headers, {len(alone)} of them compiled on their own, {len(findings)} findings, "
          f"{cpu_seconds():.0f} s CPU", *sorted(findings), sep="\n")
    return 1 if findings or not headers else 0


if __name__ == "__main__":
    sys.exit(main())
