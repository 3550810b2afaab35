#!/usr/bin/python3
"""Runs the commands that the documents tell people to type. Usage: docs_test.py PROGRAM SETUP RECORDING

PROGRAM: the built kinescope. SETUP: setup.sh of the devel space, "" without ROS. RECORDING: stands for
recording.mvnx; commands that need it are skipped, visibly, where it is absent.
A command that this file does not know how to run fails the test: a document may not say what nobody tried.
"""
import os
import pathlib
import re
import shlex
import shutil
import socket
import subprocess
import sys
import tempfile

TOP = pathlib.Path(__file__).resolve().parents[2]
PROGRAM, SETUP, RECORDING = sys.argv[1:4]
DOCUMENTS = ["README.md", "CONTRIBUTING.md", "docs/ros.md", "docs/http.md", "docs/inspect.md", "docs/loads.md", "docs/pictures.md", "docs/urdf.md",
             "tests/bench/README.md"]
passed, skipped, failed = 0, 0, 0


def commands(document):
    """Lines of ```sh blocks (and of plain ``` blocks in CONTRIBUTING.md), without comments."""
    text = (TOP / document).read_text()
    blocks = re.findall(r"^```(\w*)\n(.*?)^```", text, re.M | re.S)
    for block in (block for language, block in blocks if language in ("", "sh", "bash")):
        for line in block.replace("\\\n", " ").splitlines():
            words = shlex.split(line, comments=True)
            if words:
                yield line.split(" #")[0].strip(), words


def free_port(kind):
    with socket.socket(socket.AF_INET, kind) as s:
        s.bind(("127.0.0.1", 0))
        return str(s.getsockname()[1])


def run(words, folder, timeout=120):
    done = subprocess.run(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=timeout)
    return None if done.returncode == 0 else f"exit code {done.returncode}: {done.stdout[-500:]}"


def run_until(words, folder, line):
    """Starts it, waits for `line` in what it says, and stops it as Ctrl-C would."""
    with subprocess.Popen(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as child:
        said = ""
        for text in child.stdout:
            said += text
            if line in text:
                child.terminate()
                rest = child.communicate(timeout=20)
                return None if child.returncode == 0 else f"ended with {child.returncode}: {rest[0]}"
        return f"never said '{line}': {said}"


def with_suit(words, folder, port):
    """Runs it for a second while a suit sends to `port`."""
    suit = subprocess.Popen([PROGRAM, "stream", "demo:lift", "--to", "udp://127.0.0.1:" + port],
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        return run(words + ["--seconds", "1"], folder)
    finally:
        suit.kill()
        suit.wait()


def record_take(folder):
    port = free_port(socket.SOCK_DGRAM)
    problem = with_suit([PROGRAM, "record", "udp://127.0.0.1:" + port, "--out", "take.pcap"], folder, port)
    assert problem is None, problem


def try_kinescope(words, folder):
    words = [PROGRAM] + words[1:]
    command = words[1]
    port = free_port(socket.SOCK_STREAM if words[2:] and words[2].startswith("tcp:") else socket.SOCK_DGRAM)
    words = [re.sub(r"^(udp|tcp)://(127\.0\.0\.1)?:9763$", r"\1://127.0.0.1:" + port + ("?listen" if w.startswith("tcp:") else ""), w)
             for w in words]
    if "take.pcap" in words and command != "record":
        record_take(folder)
    if "--verify" in words:
        problem = run([PROGRAM, "render", "demo:lift", "--time", "2.5", "--out", words[words.index("--verify") + 1]], folder)
        if problem:
            return problem
    if "person.urdf" in words and "--height" not in words:
        problem = run([PROGRAM, "urdf", "--out", "person.urdf"], folder)
        if problem:
            return problem
    if command in ("record", "inspect") and any(w.startswith("udp:") for w in words):
        return with_suit(words, folder, port)
    if command in ("serve", "bridge"):
        words += ["--ros", "off", "--pictures", "off"] if command == "serve" else ["--ros", "off"]
        if command == "serve":
            words += ["--http_port", "0"]
        if not any(w.startswith(("demo:", "udp:", "tcp:", "ros:")) or w == "take.pcap" for w in words):
            words += ["--source", "udp://127.0.0.1:" + free_port(socket.SOCK_DGRAM)]
        return run_until(words, folder, "page at" if command == "serve" else "waiting for")
    if command == "stream":
        return run(words + ["--seconds", "1"], folder)
    return run(words, folder)


def attempt(line, words, folder):
    """None: worked. "skip: ...": cannot be tried here. Anything else: the failure."""
    name = words[0]
    if name in ("./check", "cmake", "ctest") or "tests/" in name or name.startswith("KINESCOPE_"):
        return "skip: this is the check itself"
    if name == "./demo":
        return "skip: has a test of its own"
    if "recording.mvnx" in words and not os.path.exists(RECORDING):
        return "skip: no recording here"
    if name == "source":
        return None if not SETUP or os.path.exists(SETUP) else f"{SETUP} is missing"
    if name in ("roslaunch", "rviz", "rosrun"):
        if not SETUP:
            return "skip: built without ROS"
        if name == "rviz":
            return "skip: needs a display"
        shell = f". {shlex.quote(SETUP)} && roslaunch --dump-params " + " ".join(words[1:])
        env_path = "/usr/bin:" + os.environ["PATH"]  # catkin asks python3 on PATH
        return run(["env", "PATH=" + env_path, "bash", "-c", shell], folder)
    if name in ("curl", "websocat", "rosservice"):
        return "skip: the tests of the server and of the node make these requests"
    if any(w.startswith("ros:") for w in words):
        if not SETUP:
            return "skip: built without ROS"
        if words[1] != "serve":
            return "skip: ros_source_test has a graph to listen to"
    if name == "kinescope" or name.endswith("/bin/kinescope"):
        return try_kinescope([RECORDING if w == "recording.mvnx" else w for w in words], folder)
    return "no test knows how to run this"


for document in DOCUMENTS:
    if not (TOP / document).exists():
        continue
    for line, words in commands(document):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(TOP / "golden_images", pathlib.Path(folder) / "golden_images")
            try:
                problem = attempt(line, words, folder)
            except subprocess.TimeoutExpired:
                problem = "did not end"
        if problem is None:
            passed += 1
            print(f"ok      {document}: {line}")
        elif problem.startswith("skip"):
            skipped += 1
            print(f"{problem[:7]:7} {document}: {line}   ({problem[6:]})")
        else:
            failed += 1
            print(f"FAILED  {document}: {line}\n        {problem}")
print(f"{passed} passed, {failed} failed, {skipped} skipped")
sys.exit(1 if failed or passed < 10 else 0)
