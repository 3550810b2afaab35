#!/usr/bin/python3
"""Runs the commands in the documents. Usage: docs_test.py PROGRAM SETUP RECORDING [--but] [DOCUMENT...]

PROGRAM: the built kinescope. SETUP: setup.sh of the devel space; "" without ROS. RECORDING: the file that replaces
recording.mvnx; commands that need it are reported as skipped if it does not exist. DOCUMENT: only these; with --but, all others.
The test fails on a command that it cannot run, because documents may contain only tested commands. It also fails on a
document that is missing or has no commands, and on a command that is never run but not listed in NEVER_RUN.
"""
import collections
import concurrent.futures
import json
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
PROGRAM, SETUP, RECORDING, *WHICH = sys.argv[1:]
DOCUMENTS = ["README.md", "CONTRIBUTING.md", "docs/alarms.md", "docs/beside.md", "docs/golden.md", "docs/ros.md", "docs/http.md", "docs/inspect.md", "docs/json.md", "docs/loads.md", "docs/many_machines.md", "docs/motion.md", "docs/page.md", "docs/pictures.md", "docs/pose.md", "docs/rviz_files.md", "docs/urdf.md",
             "tests/bench/README.md", "tests/soak/README.md"]
# Document -> first words of its commands that this test never runs.
NEVER_RUN = {
    "README.md": ["./demo", "./check"],
    "CONTRIBUTING.md": ["./check", "./check", "./check", "cmake", "cmake", "build/fuzz/tests/fuzz/datagram_fuzz"],
    "docs/ros.md": ["kinescope inspect ros:", "kinescope urdf ros:", "rosservice", "rosservice", "rosservice",
                    "rosrun dynamic_reconfigure", "rosrun dynamic_reconfigure"],
    "docs/http.md": ["node docs/watch.mjs"],
    "tests/bench/README.md": ["tests/bench/measure.sh", "build/dev/tests/bench/mvn_bench", "build/dev/tests/bench/loads_bench",
                              "build/dev/tests/bench/render_bench", "tests/bench/clip.sh", "tests/bench/memory_parts.py",
                              "tests/bench/rviz_peer.sh",
                              "build/dev/tests/bench/growth", "build/dev/tests/bench/memory_flat",
                              "tests/bench/frozen_master.py", "tests/bench/ros_rates.sh"],
    "tests/soak/README.md": ["tests/soak/soak.py"],
}
os.environ["CI"] = ""  # as on a person's machine: golden pictures are accepted there
os.environ["ROS_MASTER_URI"] = "http://127.0.0.1:1"  # leaves a running ROS master alone
LIMIT_SECS = 600  # only ends what hangs: `golden stress` draws at the lowest priority, too, which lasts as long as a build beside it
AT_ONCE = 2  # commands; some of them wait for a simulated suit
# The golden cases that the commands name, and some of each kind: `ctest -R golden_images` draws all of them.
GOLDEN_CASES = ["lift_bend_right", "no_data", "lift_views_dark", "markers", "pose_one_leg", "walk_clip"]
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


def free_port(kind, after=iter(range(100 * os.getpid(), sys.maxsize))):
    """Below the range from which the kernel gives ports to others who ask for any, so that it stays free. Each process that runs this
    test begins elsewhere."""
    end = int(pathlib.Path("/proc/sys/net/ipv4/ip_local_port_range").read_text().split()[0])
    for i in after:
        port = 10000 + i % (end - 10000)
        with socket.socket(socket.AF_INET, kind) as s:
            try:
                s.bind(("127.0.0.1", port))
            except OSError:
                continue
            return str(port)


def run(words, folder, timeout=LIMIT_SECS):
    done = subprocess.run(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=timeout)
    return None if done.returncode == 0 else f"exit code {done.returncode}: {done.stdout[-500:]}"


def run_until(words, folder, line, expected=0):
    """Starts the command, waits for `line` in its output, and stops it with SIGTERM. It ends with the exit code `expected`."""
    with subprocess.Popen(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as child:
        said = ""
        for text in child.stdout:
            said += text
            if line in text:
                child.terminate()
                rest = child.communicate(timeout=20)
                return None if child.returncode == expected else f"ended with {child.returncode}: {rest[0]}"
        return f"never printed '{line}': {said}"


def with_suit(words, folder, port):
    """Runs the command for one second while a simulated suit sends to `port`."""
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


def write_forces(folder):
    """A few seconds of a person who stands on two plates, as the documents call the files."""
    times = [i / 100 for i in range(300)]
    header = "time_s,body,fx_N,fy_N,fz_N,px_m,py_m,pz_m,tx_Nm,ty_Nm,tz_Nm\n"
    (folder / "forces.csv").write_text(header + "".join(f"{t},LeftHand,0,0,-20,,,,0,0,0\n" for t in times))
    labels = [f"ground_{q}_{plate}_{p}{axis}" for plate in (1, 2) for q, p in (("force", "v"), ("force", "p"), ("torque", "")) for axis in "xyz"]
    foot = "0\t368\t0\t0\t0\t{}\t0\t0\t0"
    rows = "".join(f"{t}\t{foot.format(0.1)}\t{foot.format(-0.1)}\n" for t in times)
    (folder / "forces.mot").write_text("plates\nendheader\ntime\t" + "\t".join(labels) + "\n" + rows)


def try_curl(line, folder):
    """Makes the request of the document to a server with a simulated suit. What is written there as an address and as the
    number of a state becomes that of this server."""
    port = free_port(socket.SOCK_DGRAM)
    words = [PROGRAM, "serve", "udp://127.0.0.1:" + port, "--http_port", "0"]
    if "kinescope.token" in line:
        (pathlib.Path(folder) / "kinescope.token").write_text("a-token-of-a-lab-1234\n")
        words += ["--token_file", "kinescope.token"]
    home = {**os.environ, "XDG_STATE_HOME": folder}
    with subprocess.Popen(words, cwd=folder, env=home, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as server, \
            subprocess.Popen([PROGRAM, "stream", "demo:lift", "--to", "udp://127.0.0.1:" + port], stdout=subprocess.DEVNULL,
                             stderr=subprocess.DEVNULL) as suit:
        try:
            said = ""
            for text in server.stdout:
                said += text
                if " live: " in text:
                    break
            url = re.search(r"page at (http://[\d.]+:\d+)", said)
            if not url:
                return f"the server does not start: {said}"
            line = re.sub(r"http://[\d.]+:\d+", url[1], line)
            if '"state":' in line:
                state = json.loads(subprocess.run(["curl", "-s", url[1] + "/api/v1/state"], stdout=subprocess.PIPE, check=True).stdout)
                line = re.sub(r'"state": \d+', f'"state": {state["state_number"]}', line)
            return run(["bash", "-c", line.replace("curl ", "curl --fail-with-body ", 1)], folder)
        finally:
            server.kill()
            suit.kill()


def write_marks(folder):
    """A mark of a take of the past."""
    moment = {"state": 7, "micros": 7, "stamp_micros": 1763900000000000, "time_code_millis": 43200000, "counter": 6}
    mark = {"id": 1, "revision": 1, "run_micros": 1763900000000000, "kind": "mark", "button": 0, "text": "belt slipped", "role": "operator", "at": moment, "end": None,
            "is_open": False, "is_removed": False, "behind_secs": 0, "pressed_micros": 1763900000000000}
    (pathlib.Path(folder) / "marks.jsonl").write_text(json.dumps(mark) + "\n")


def write_rules(folder):
    """The rules which the document shows as its example."""
    rules = re.search(r"^```yaml\n(.*?)^```", (TOP / "docs/alarms.md").read_text(), re.M | re.S)[1]
    (pathlib.Path(folder) / "rules.yaml").write_text(rules)


def try_batch(line, words, folder):
    """`jobs`, `batch` and `study`, with a trial of a study and folders for what is made of it."""
    folder = pathlib.Path(folder)
    for name in ("trials", "clips", "loads"):
        (folder / name).mkdir()
    problem = run([PROGRAM, "convert", "demo:lift", "--seconds", "0.1", "--out", "trials/S07_lift_001.mvnx"], folder)
    if problem:
        return problem
    jobs = [{"id": f"{camera}", "command": "render", "options": {"source": "trials/S07_lift_001.mvnx", "camera": camera, "size": "64x64",
                                                                "out": f"clips/{camera}.png"}} for camera in ("front", "side")]
    if words[1] == "study" or "loads.jsonl" in words:
        problem = run(["bash", "-c", f"{shlex.quote(PROGRAM)} jobs 'trials/*.mvnx' --command loads --samples none --json 'loads/{{source}}.json' "
                                     "--labels '{person}_{condition}_{trial}' > loads.jsonl"], folder)
        problem = problem or (words[1] == "study" and run([PROGRAM, "batch", "loads.jsonl"], folder))
        if problem:
            return problem
    if words[1] == "batch":
        (folder / "jobs.jsonl").write_text("".join(json.dumps(job) + "\n" for job in jobs))
    if "--check" in words:
        problem = run([PROGRAM, "batch", "jobs.jsonl"], folder)
        if problem:
            return problem
    return run(["bash", "-c", line.replace("kinescope", shlex.quote(PROGRAM), 1)], folder)


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
    if command == "strip":
        problem = run([PROGRAM, "render", "demo:walk", "--seconds", "0.2", "--size", "640x360", "--overlay", "frame_code",
                       "--out", "walk.mp4"], folder)
        if problem:
            return problem
    if "person.urdf" in words and "--height" not in words:
        problem = run([PROGRAM, "urdf", "--out", "person.urdf"], folder)
        if problem:
            return problem
    if "accept" in words or "review" in words:
        (pathlib.Path(folder) / "golden_images/lift_bend_right.yaml").open("a").write("mass: 90\n")
        run([PROGRAM, "golden", "check", "golden_images"], folder)
    if "review" in words:
        return run_until(words, folder, "http://127.0.0.1:", expected=1)  # nothing is decided
    if words[1:3] == ["golden", "compare"]:
        for backend in ("osmesa", "egl"):
            problem = run([PROGRAM, "render", "demo:lift", "--time", "3", "--size", "320x180", "--backend", backend, "--out",
                           backend + ".png"], folder)
            if problem:
                return problem
    if "--tls_certificate" in words:
        problem = run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-subj", "/CN=lab",
                       "-keyout", "lab.key", "-out", "lab.pem"], folder)
        if problem:
            return problem
    if any(word.endswith("skin:person.glb") for word in words):
        problem = run([PROGRAM, "urdf", "--out", "person.glb"], folder)
        if problem:
            return problem
    if "marks.jsonl" in words:
        write_marks(folder)
    if "rules.yaml" in words:
        write_rules(folder)
    if "--wrenches" in words:
        write_forces(pathlib.Path(folder))
    if command in ("record", "inspect") and any(w.startswith("udp:") for w in words):
        return with_suit(words, folder, port)
    if command in ("serve", "bridge"):
        if command == "serve":
            words += ["--http_port", "0"]
            words += [] if any(w.startswith("--ros_view") for w in words) else ["--pictures", "off"]
        if not any(w.startswith(("demo:", "udp:", "tcp:", "ros:")) or w == "take.pcap" for w in words):
            words += ["--source", "udp://127.0.0.1:" + free_port(socket.SOCK_DGRAM)]
        return run_until(words, folder, "page at" if command == "serve" else "waiting for")
    if command == "stream":
        return run(words + ["--seconds", "1"], folder)
    if words[1:3] == ["golden", "stress"]:  # each case is drawn ten times
        for case in words[4:]:
            (pathlib.Path(folder) / f"golden_images/{case}.yaml").open("a").write("size: 320x180\n")
    if command == "render" and "--out" in words:  # the processor draws and encodes
        words += [] if "--size" in words else ["--size", "640x360"]
        is_clip = any(word.endswith((".mp4", ".webm", ".gif")) for word in words)
        words += ["--seconds", "1"] if is_clip and RECORDING in words else []
    return run(words, folder)


def attempt(line, words, folder):
    """None: success. "never: ...": this test never runs it. "skip: ...": not possible on this machine. Any other text: the failure."""
    name = words[0]
    if name in ("./check", "cmake", "ctest") or "tests/" in name or name.startswith("KINESCOPE_"):
        return "never: part of the checks"
    if name == "./demo":
        return "never: has its own test"
    if "recording.mvnx" in words and not os.path.exists(RECORDING):
        return "skip: the recording does not exist"
    if name == "source":
        return None if not SETUP or os.path.exists(SETUP) else f"{SETUP} is missing"
    if name == "rosservice" or words[:2] == ["rosrun", "dynamic_reconfigure"]:
        return "never: the tests of the node make these requests"
    if name in ("roslaunch", "rviz", "rosrun"):
        if not SETUP:
            return "skip: built without ROS"
        if name == "rviz":
            return "skip: needs a display"
        shell = f". {shlex.quote(SETUP)} && roslaunch --dump-params " + " ".join(words[1:])
        env_path = "/usr/bin:" + os.environ["PATH"]  # catkin runs python3 from PATH
        return run(["env", "PATH=" + env_path, "bash", "-c", shell], folder)
    if name == "openssl":
        return run(words, folder)
    if name == "curl":
        return try_curl(line, folder)
    if line.startswith("node docs/watch.mjs"):
        return "never: client.test.mjs runs it"
    if any(w.startswith("ros:") for w in words):
        if words[1] != "serve":
            return "never: ros_source_test runs it with a ROS graph"
        if not SETUP:
            return "skip: built without ROS"
    if words[:2] in (["kinescope", "jobs"], ["kinescope", "batch"], ["kinescope", "study"]):
        return try_batch(line, words, folder)
    if name == "kinescope" or name.endswith("/bin/kinescope"):
        return try_kinescope([RECORDING if w == "recording.mvnx" else w for w in words], folder)
    return "docs_test.py cannot run this command"


def is_word_of(line, word):
    return line == word or line.startswith(word + " ")


def fail(document, problem):
    global failed
    failed += 1
    print(f"FAILED  {document}: {problem}")


def check_lists():
    """Documents with commands are in DOCUMENTS, and the tests that docs/security.md names are there."""
    for path in [*TOP.glob("*.md"), *TOP.glob("docs/*.md"), *TOP.glob("tests/*/*.md")]:
        name = str(path.relative_to(TOP))
        if name not in DOCUMENTS and re.search(r"^```(sh|bash)$", path.read_text(), re.M):
            fail(name, "contains commands, but is not in DOCUMENTS")

    tests = "\n".join(path.read_text() for kind in ("*.cc", "*.py") for path in (TOP / "tests").rglob(kind) if "node_modules" not in path.parts)
    for name in re.findall(r"`([^`]+)`(?=[^|`]*(?:`[^`]+`[^|`]*)*\|$)", (TOP / "docs/security.md").read_text(), re.M):
        if re.fullmatch(r"[\w.]+\.test\.mjs", name):
            found = (TOP / "tests/browser" / name).exists()
        elif name.endswith("_fuzz"):
            found = (TOP / "tests/fuzz" / (name + ".cc")).exists()
        elif name.startswith("test_"):
            found = f"def {name}(" in tests
        else:
            suite, _, case = name.partition(".")
            found = re.search(rf"TEST(_F|_P)?\({suite},\s+{case}\)", tests) is not None
        if not found:
            fail("docs/security.md", f"there is no test {name}")


def write_golden_folder(folder):
    """GOLDEN_CASES and what they read, as a person has them who begins with golden images."""
    def is_of_another_case(_, names):
        return [name for name in names if name.split(".")[0].split("@")[0] not in (*GOLDEN_CASES, "golden")
                and name.endswith((".yaml", ".png"))]
    shutil.copytree(TOP / "golden_images", folder / "golden_images", ignore=is_of_another_case)
    lock = folder / "golden_images/golden.lock"
    content = json.loads(lock.read_text())
    content["cases"] = {name: case for name, case in content["cases"].items() if name.split("@")[0] in GOLDEN_CASES}
    lock.write_text(json.dumps(content))


def try_command(line, words):
    """What attempt() tells, in a folder of its own."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_golden_folder(folder)
        shutil.copytree(TOP / "launch", folder / "launch")
        try:
            return attempt(line, words, name)
        except subprocess.TimeoutExpired:
            return "timeout"


def check_document(document, pool):
    global passed, skipped
    if not (TOP / document).exists():
        fail(document, "file not found; update DOCUMENTS")
        return
    expected = collections.Counter(NEVER_RUN.get(document, []))
    found = list(commands(document))
    for (line, _), problem in zip(found, pool.map(lambda each: try_command(*each), found)):
        if problem is None:
            passed += 1
            print(f"ok      {document}: {line}", flush=True)
        elif problem.startswith(("skip:", "never:")):
            skipped += 1
            kind, reason = problem.split(": ", 1)
            print(f"{kind:7} {document}: {line}   ({reason})")
            if kind == "never":
                known = next((word for word, left in expected.items() if left > 0 and is_word_of(line, word)), None)
                expected[known] -= 1
                if known is None:
                    fail(document, f"{line}\n        is never run, but not listed in NEVER_RUN")
        else:
            fail(document, f"{line}\n        {problem}")
    if not found:
        fail(document, "contains no commands; expected code blocks in language sh")
    for word, left in expected.items():
        if word is not None and left > 0:
            fail(document, f"'{word}' is missing or is run now; remove it from NEVER_RUN")


is_but = WHICH[:1] == ["--but"]
named = WHICH[1:] if is_but else WHICH or DOCUMENTS
for name in named:
    if name not in DOCUMENTS:
        fail(name, "is not in DOCUMENTS")
if is_but or not WHICH:
    check_lists()
with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as commands_at_once:
    for each in DOCUMENTS:
        if (each in named) != is_but:
            check_document(each, commands_at_once)
print(f"{passed} passed, {failed} failed, {skipped} skipped")
sys.exit(1 if failed else 0)
