"""A small study for the tests of engines: recordings, a list of jobs and what became of them, in a folder of its own."""
import collections
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys

RECIPES = pathlib.Path(__file__).resolve().parents[2] / "launch/many"
SKIPPED = 77  # exit code of a test that cannot run here


def need(programs):
    """Ends the test as skipped if a program is missing. `programs`: name -> Debian package."""
    path = os.environ["PATH"] + ":/usr/sbin"
    missing = sorted({package for name, package in programs.items() if not shutil.which(name, path=path)})
    if missing:
        print("skipped: install " + " ".join(missing))
        sys.exit(SKIPPED)


def share_of(job_id, shares):
    """As kinescope batch --shard has it."""
    return int(hashlib.sha256(job_id.encode()).hexdigest()[:16], 16) % shares + 1


def id_in(share, shares, stem):
    """An id that begins with `stem` and is in that share."""
    return next(name for name in (f"{stem}-{i}" for i in range(100_000)) if share_of(name, shares) == share)


class Study:
    def __init__(self, program, folder):
        self.program = pathlib.Path(program).resolve()
        self.folder = pathlib.Path(folder)
        # The recipes call `kinescope`. Caches and the like stay in the folder.
        self.environment = {**os.environ, "PATH": f"{self.program.parent}:{os.environ['PATH']}", "HOME": str(self.folder),
                            "XDG_CACHE_HOME": str(self.folder / ".cache")}
        self.jobs = []

    def kinescope(self, *words):
        return subprocess.run([self.program, *words], cwd=self.folder, env=self.environment, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)

    def record(self, name):
        """A recording of a tenth of a second."""
        done = self.kinescope("convert", "demo:lift", "--seconds", "0.1", "--out", name)
        assert done.returncode == 0, done.stdout

    def add(self, job_id, command, **options):
        self.jobs.append({"id": job_id, "command": command, "options": options})

    def add_pictures(self, count):
        for i in range(count):
            self.add(f"picture{i}", "render", source="demo:lift", time=i / 10, size="64x64", out=f"picture{i}.png")

    def add_waiting(self, job_id):
        """A job whose recording is a named pipe, so it waits for the test."""
        os.mkfifo(self.folder / f"{job_id}.mvnx")
        self.add(job_id, "loads", source=f"{job_id}.mvnx", csv=f"{job_id}.csv")

    def meet(self, job_id):
        """Returns when the waiting job is under way, with what keeps it waiting until it is closed."""
        return open(self.folder / f"{job_id}.mvnx", "wb", buffering=0)

    def let_go(self, job_id):
        """From now on the recording of the waiting job is a file."""
        (self.folder / f"{job_id}.mvnx").unlink()
        self.record(f"{job_id}.mvnx")

    def write_list(self, name="jobs.jsonl"):
        (self.folder / name).write_text("".join(json.dumps(job) + "\n" for job in self.jobs))

    def results(self, pattern="jobs.results*.jsonl"):
        """All results by id; a job with two of them fails the test."""
        found = {}
        for path in sorted(self.folder.glob(pattern)):
            for line in path.read_text().splitlines():
                result = json.loads(line)
                assert result["id"] not in found, f"two results: {result}"
                found[result["id"]] = result
        return found

    def states(self):
        return collections.Counter(result["state"] for result in self.results().values())

    def expect_complete(self):
        checked = self.kinescope("batch", "jobs.jsonl", "--check")
        assert checked.returncode == 0, checked.stdout
        ids = {job["id"] for job in self.jobs}
        results = self.results()
        assert set(results) == ids, set(results) ^ ids
        assert set(self.states()) <= {"done", "kept"}, self.states()
        self.expect_no_leftovers()

    def expect_no_leftovers(self):
        """Neither parts of files nor processes."""
        parts = [path.name for path in self.folder.rglob("*.part")]
        assert not parts, parts
        assert not self.processes(), self.processes()

    def processes(self):
        """Command lines, by id, of the processes of kinescope that work in the folder."""
        found = {}
        for entry in pathlib.Path("/proc").iterdir():
            if not entry.name.isdigit():
                continue
            try:
                if os.readlink(entry / "cwd") != str(self.folder.resolve()):
                    continue
                words = (entry / "cmdline").read_bytes().split(b"\0")
            except OSError:
                continue  # it has ended
            if words[0].endswith(b"kinescope"):
                found[int(entry.name)] = [word.decode() for word in words if word]
        return found
