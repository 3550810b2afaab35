#!/usr/bin/python3
"""Checks real outputs of `kinescope loads` against docs/loads.schema.json and docs/loads.md.
Usage: loads_schema_test.py PROGRAM SHARED_DATA

SHARED_DATA: folder of recordings; what needs one of them is reported as skipped if it does not exist.
Every output must be valid, also if no member but those of the schema were allowed: so a new member must be described.
Every column must be described in docs/loads.md, and every described column must exist.
"""
import csv
import json
import pathlib
import re
import socket
import subprocess
import sys
import tempfile
import threading

import jsonschema

from strict_schema import strict

TOP = pathlib.Path(__file__).resolve().parents[2]
PROGRAM, SHARED = sys.argv[1], pathlib.Path(sys.argv[2])
SCHEMA = json.loads((TOP / "docs/loads.schema.json").read_text())
ALL = ["--joints", "all", "--columns", "all"]
failed = 0


def fail(problem):
    global failed
    failed += 1
    print("FAILED  " + problem)


def loads(*arguments, may_end_with=(0,)):
    done = subprocess.run([PROGRAM, "loads", *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=120)
    if done.returncode not in may_end_with:
        fail(f"loads {' '.join(arguments)}: exit code {done.returncode}: {done.stderr}")
    return done.stdout


def check_output(name, people, *arguments, may_end_with=(0,)):
    output = json.loads(loads(*arguments, "--json", "-", may_end_with=may_end_with))
    for schema in (SCHEMA, strict(SCHEMA)):
        for error in jsonschema.Draft202012Validator(schema).iter_errors(output):
            fail(f"{name}: {'/'.join(map(str, error.absolute_path))}: {error.message[:300]}")
    widths = {len(sample) for sample in output["samples"]}
    if widths != {len(output["columns"])}:
        fail(f"{name}: {len(output['columns'])} columns, but samples of {widths} values")
    if len(output["people"]) != people:
        fail(f"{name}: {len(output['people'])} people; expected {people}")
    print(f"ok      {name}: {len(output['samples'])} samples, {len(output['columns'])} columns")
    return output


def record_people(path, count):
    """What a suit with several people sends, as a file of datagrams."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
        receiver.bind(("127.0.0.1", 0))
        received, ended = [], threading.Event()

        def receive():
            receiver.settimeout(0.2)
            while True:
                try:
                    received.append(receiver.recv(65536))
                except socket.timeout:
                    if ended.is_set():
                        return

        thread = threading.Thread(target=receive)
        thread.start()
        to = "udp://127.0.0.1:%d" % receiver.getsockname()[1]
        subprocess.run([PROGRAM, "stream", "demo:walk", "--to", to, "--characters", str(count), "--seconds", "0.5"],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=60)
        ended.set()
        thread.join()
    path.write_bytes(b"".join(received))


def documented_columns():
    """Of the tables between "## CSV" and "## JSON" in docs/loads.md: names of the body, names of a joint."""
    section = (TOP / "docs/loads.md").read_text().partition("\n## CSV\n")[2].partition("\n## JSON\n")[0]
    body, joint = set(), set()
    is_joint = False
    for line in section.splitlines():
        is_joint = is_joint or line.startswith("For each of the 15 joints")
        is_joint = is_joint and not line.startswith("With `--columns all`, for the body")
        if line.startswith("| `"):
            names = re.findall(r"`(\w+)`", line.split(" | ")[0])
            (joint if is_joint else body).update(expand(names, "…" in line.split(" | ")[0]))
    return body, joint


def expand(names, has_more):
    """`com_x_m` … stands for the three axes; with "right" it stands for the left, too."""
    for name in names:
        axes = [name]
        if has_more and "_x_" in name:
            # The centre of pressure of a foot is on the floor.
            axes = [name.replace("_x_", f"_{axis}_") for axis in ("xy" if "_cop_" in name else "xyz")]
        for column in axes:
            yield column
            if has_more and column.startswith("right_"):
                yield "left_" + column[len("right_"):]


def check_documents(columns, joints):
    in_body, in_joint = documented_columns()
    is_of_joint = re.compile(SCHEMA["$defs"]["column"]["anyOf"][2]["pattern"])
    known_twice = {"l5_s1_moment_ratio", "l5_s1_compression_ratio", "l5_s1_compression_N", "l5_s1_shear_N"}
    real_body = {c for c in columns if not is_of_joint.match(c) or c in known_twice}
    real_joint = {is_of_joint.match(c).group(2) for c in columns if is_of_joint.match(c) and c not in known_twice}
    for what, real, documented in (("body", real_body, in_body), ("joint", real_joint, in_joint)):
        for name in sorted(real - documented):
            fail(f"docs/loads.md: column {name} of the {what} is not described")
        for name in sorted(documented - real):
            fail(f"docs/loads.md: column {name} of the {what} does not exist")
    if len(joints) != 22:
        fail(f"--joints all: {len(joints)} joints; expected 22")


jsonschema.Draft202012Validator.check_schema(SCHEMA)
check_output("a lift", 1, "demo:lift", "--seconds", "2", "--hand_load", "both:10")
full = check_output("a walk, every joint and column", 1, "demo:walk", "--seconds", "2", *ALL)
check_output("a person without any known load", 1, "demo:lift", "--seconds", "0.5", "--load_metric", "external", *ALL, may_end_with=(1,))
check_output("a person who sits", 1, "demo:sit", "--seconds", "0.5", "--load_metric", "overload", "--hand_load", "left:3")
if (SHARED / "mvnx/test_mocap.mvnx").exists():
    upper_body = check_output("an upper body without legs", 1, str(SHARED / "mvnx/test_mocap.mvnx"), *ALL)
    row = dict(zip(upper_body["columns"], upper_body["samples"][-1]))
    if row["right_knee_ratio"] is not None or row["floor_reason"] is None:
        fail("an upper body: its legs have loads, or its floor is found")
else:
    print("skip    an upper body without legs: the recording does not exist")
with tempfile.TemporaryDirectory() as folder:
    several = pathlib.Path(folder) / "people.bin"
    record_people(several, 3)
    check_output("three people", 3, str(several), *ALL)

rows = list(csv.reader(loads("demo:walk", "--seconds", "0.1", "--csv", "-", *ALL).splitlines()))
if rows[0] != full["columns"]:
    fail("CSV and JSON have different columns")
tall = list(csv.reader(loads("demo:walk", "--seconds", "0.1", "--csv", "-", "--layout", "long", *ALL).splitlines()))
check_documents(full["columns"], {row[4] for row in tall[1:]})
sys.exit(1 if failed else 0)
