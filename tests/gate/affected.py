"""What a change can affect: which programs Ninja would build again, and which tests start them.

A program is affected if a changed file is among what it was last built from: Ninja's graph has the sources, its log of dependencies
the headers. A test is affected if its program is, or one that this depends on because it starts it; tests without a program of the
build (scripts) that are labelled `system` start the whole of Kinescope. Files that are not compiled belong to tests by OWNERS below, and to tests that have their path in the command. A changed file that nothing here
knows affects everything; so does a build folder that is not there yet.
"""
import copy
import json
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from changes import git, names_changed_since  # noqa: E402
from compile_flags import TOP  # noqa: E402

PROGRAM, MODULES = "bin/kinescope", "kinescope_modules"
EVERYTHING = re.compile(r"(^|/)CMakeLists\.txt$|^cmake/|^CMakePresets\.json$|^packages\.txt$|^check$|^tests/gate/|^tests/[^/]*$|\.in$")
OWNERS = (  # files that are not compiled -> names of tests that read them
    (r"^web/|^tests/browser/", r"web_unit|browser_.*|installation|system_test\.(Page|Golden|Dashboard|Sinks).*|ros_system_test\.(Pipeline|View).*"),
    (r"^docs/|^[A-Z]+\.md$", r"documents\..*|loads_schema|http_api|golden_example"),
    (r"^golden_images/", r"golden_.*|documents\..*"),
    (r"^launch/|^package\.xml$", r"rostest.*|launch_files|many_.*|catkin_workspace|documents\..*|installation|ros_system_test.*"),
    (r"^tests/many/", r"many_.*"),
    (r"^tests/fuzz/corpus/", r"fuzz\..*"),
    (r"^demo$", r"scripts|demo_targets|documents\..*"),
    (r"^tests/soak/|^\.ci/|^LICENSE$|^\.git|^\.clang", r"$^"),
)
COMPILED = re.compile(r"\.(cc|h|cpp|hpp|c)$")


class UnknownRevision(Exception):
    pass


class Change:
    """The files that differ from a revision, new and removed ones included."""

    def __init__(self, revision):
        if git("rev-parse", "--verify", "--quiet", f"{revision}^{{commit}}") is None:
            raise UnknownRevision(f"--since={revision}: unknown revision; `git log --oneline` lists those there are")
        self.revision = revision
        self.files = names_changed_since(revision, with_removed=True)
        self.for_everything = sorted(name for name in self.files if self._owner(name) is None and not COMPILED.search(name)
                                     or EVERYTHING.search(name))

    @staticmethod
    def _owner(name):
        return next((tests for files, tests in OWNERS if re.search(files, name)), None)

    def owned_tests(self):
        return [self._owner(name) for name in self.files if self._owner(name) is not None and not COMPILED.search(name)]


class Build:
    """A build folder as it was last built."""

    def __init__(self, folder):
        self._folder = folder
        self._targets = {line.rsplit(": ", 1)[0] for line in self._ninja("-t", "targets", "all")}
        self._headers = {}  # object -> files that it was compiled from
        objects = None
        for line in self._ninja("-t", "deps"):
            if line.startswith("    "):
                objects.add(self._name(line.strip()))
            elif ": #deps" in line:
                objects = self._headers.setdefault(line.split(": #deps")[0], set())

    def _ninja(self, *words):
        result = subprocess.run(["ninja", "-C", self._folder, *words], capture_output=True, text=True)
        return result.stdout.splitlines() if result.returncode == 0 else []

    def _name(self, path):
        """From the top folder; None: not ours."""
        full = pathlib.Path(self._folder, path).resolve() if not path.startswith("/") else pathlib.Path(path)
        return full.relative_to(TOP).as_posix() if TOP in full.parents else None

    def sources_of(self, target):
        """Everything of ours from which the target is built, and what it starts with that; None: it was not built as a whole yet."""
        inputs = self._ninja("-t", "inputs", target)
        if any(line == PROGRAM or line.endswith(MODULES) for line in inputs) or target == PROGRAM:
            inputs += self._ninja("-t", "inputs", MODULES)  # Ninja does not look behind this name; they are loaded, not linked
        if any(line.endswith(".o") and line not in self._headers for line in inputs):
            return None
        return {self._name(line) for line in inputs}.union(*(self._headers.get(line, ()) for line in inputs)) - {None}

    def is_built(self):
        return bool(self._headers)

    def tests(self, preset):
        """Those that this preset of ctest has."""
        words = ["ctest", "--preset", preset, "--show-only=json-v1"]
        result = subprocess.run(words, capture_output=True, text=True, cwd=TOP)
        return json.loads(result.stdout)["tests"] if result.returncode == 0 else []

    def programs_of(self, test):
        """Those of this build in its command, as Ninja calls them."""
        paths = [pathlib.Path(word) for word in test.get("command", []) if word.startswith("/")]
        names = [path.relative_to(self._folder).as_posix() for path in paths if self._folder in path.parents]
        return [name for name in names if name in self._targets]


def is_system_test(test):
    labels = next((p["value"] for p in test.get("properties", []) if p["name"] == "LABELS"), [])
    return "system" in labels


def affected_tests(change, build, preset):
    """(names of tests that the change can affect, programs to build for them, names of all tests)"""
    known = {}

    def hits(target):
        if target not in known:
            sources = build.sources_of(target)
            known[target] = sources is None or bool(sources & change.files)
        return known[target]

    owned = re.compile("|".join(f"(?:{pattern})" for pattern in change.owned_tests()) or "$^")
    names, programs, every = [], set(), []
    for test in build.tests(preset):
        every.append(test["name"])
        of_test = build.programs_of(test) or ([PROGRAM] if is_system_test(test) else [])
        is_hit = (owned.fullmatch(test["name"]) or any(map(hits, of_test))
                  or any(name in word for word in test.get("command", []) for name in change.files))
        if is_hit:
            names.append(test["name"])
            programs.update(of_test)
    return names, programs, every


def pattern_of(names, every):
    """A regular expression for ctest: whole programs where all of their tests are meant."""
    words = []
    chosen = set(names)
    for program in sorted({name.split(".")[0] for name in names}):
        of_program = [name for name in every if name.split(".")[0] == program]
        if chosen.issuperset(of_program):
            words.append(rf"{program}(\..*)?")
        else:
            words += [re.escape(name) for name in of_program if name in chosen]
    return "^(" + "|".join(words) + ")$"


def narrowed(stages, change):
    """Copies of the stages with what the change can affect; prints what is left out."""
    print(f"--since {change.revision}: {len(change.files)} files differ")
    if change.for_everything:
        print(f"nothing is left out, because of {', '.join(change.for_everything[:3])}")
        return stages
    result = []
    for stage in stages:
        stage = copy.deepcopy(stage)
        commands = [command for command in map(lambda c: _narrowed(c, change), stage.commands) if command is not None]
        if not commands:
            print(f"left out: {stage.name}")
            continue
        stage.commands = commands
        result.append(stage)
    for stage in result:
        stage.needs = tuple(need for need in stage.needs if need in {s.name for s in result})
    return result


def _narrowed(command, change):
    if command.preset is None:
        return command
    build = Build(TOP / "build" / ("dev" if command.preset.startswith("dev") else command.preset))
    if not build.is_built():
        return command
    names, programs, every = affected_tests(change, build, command.preset)
    if not names:
        return None
    command = copy.deepcopy(command)
    if command.builds:
        command.words += sorted(programs | ({PROGRAM, MODULES} if command.preset == "dev" else set()))
    else:
        print(f"left out: {len(every) - len(names)} of {len(every)} tests of {command.preset}")
        command.words += ["-R", pattern_of(names, every)]
    return command
