#!/usr/bin/python3
"""Checks the answers of a running server against docs/openapi.json.
Usage: http_api_test.py PROGRAM

Every operation is sent without a token, with a viewer's and with the operator's. Every answer must have the described type and, if it is
JSON, be valid; also if no member but those of the schema were allowed, so that a new member must be described.
"""
import http.client
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

import jsonschema

from strict_schema import strict

TOP = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = sys.argv[1]
OPERATOR, VIEWER = "operator-of-the-lab", "viewers-of-the-lab"
PATIENCE_SECS = 60
DESCRIPTION = json.loads((TOP / "docs/openapi.json").read_text())
failed = 0


def fail(problem):
    global failed
    failed += 1
    print("FAILED  " + problem)


class Server:
    def __init__(self, *arguments):
        self.folder = tempfile.TemporaryDirectory()
        environment = {**os.environ, "XDG_STATE_HOME": self.folder.name}
        self.process = subprocess.Popen(
            [PROGRAM, "serve", "demo:walk", "--http_port", "0", "--token", OPERATOR, "--viewer_token", VIEWER, *arguments],
            stderr=subprocess.PIPE, text=True, env=environment)
        for line in self.process.stderr:
            found = re.search(r"page at http://127\.0\.0\.1:(\d+)/", line)
            if found:
                self.port = int(found.group(1))
                break
        else:
            sys.exit("the server has not started")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.communicate()
        self.folder.cleanup()

    def send(self, method, target, token=OPERATOR, body=None):
        """Status, type and content of the answer."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE_SECS)
        headers = {"Content-Type": "application/json"} if body is not None else {}
        if token:
            headers["Authorization"] = "Bearer " + token
        connection.request(method, target, None if body is None else json.dumps(body), headers)
        answer = connection.getresponse()
        content = answer.read()
        connection.close()
        return answer.status, answer.getheader("Content-Type"), content

    def wait_until_found(self, target):
        end = time.monotonic() + PATIENCE_SECS
        while self.send("GET", target)[0] == 404:
            if time.monotonic() > end:
                sys.exit(f"{target} is never there")

    def wait_for(self, target, is_wanted):
        end = time.monotonic() + PATIENCE_SECS
        while time.monotonic() < end:
            value = json.loads(self.send("GET", target)[2])
            if is_wanted(value):
                return value
        sys.exit(f"{target} does not become what the test waits for: {value}")


def resolved(part):
    while "$ref" in part:
        found = DESCRIPTION
        for name in part["$ref"][2:].split("/"):
            found = found[name]
        part = found
    return part


def problems_of(value, schema):
    """What is wrong with `value`, with and without members that are not described."""
    whole = {**schema, "components": DESCRIPTION["components"]}
    return [f"{error.json_path}: {error.message}" for each in (whole, strict(whole))
            for error in jsonschema.Draft202012Validator(each).iter_errors(value)]


def check_answer(name, operation, answer):
    """Returns the content, parsed if it is JSON."""
    status, content_type, content = answer
    described = resolved(operation["responses"].get(str(status), operation["responses"]["default"]))
    types = described.get("content", {})
    if content_type not in types:
        return fail(f"{name}: {status} has the type {content_type}; described are {', '.join(types)}")
    if content_type != "application/json":
        return content
    value = json.loads(content)
    for problem in problems_of(value, types[content_type]["schema"])[:5]:
        fail(f"{name}: {status}: {problem}")
    return value


def expect(name, server, operation, status, method, target, token=OPERATOR, body=None):
    answer = server.send(method, target, token, body)
    if answer[0] != status:
        fail(f"{name}: expected {status}, got {answer[0]}: {answer[2][:200]}")
    return check_answer(name, operation, answer)


def operations():
    for path, methods in DESCRIPTION["paths"].items():
        for method, operation in methods.items():
            yield path, method.upper(), operation


# Of an operator's request with the example of the description; else 200.
STATUS = {
    "openSocket": 426,  # the upgrade is not asked for
    "acknowledgeAlarm": 409,  # there is none of this number
    "setRecording": 409,  # of a source that is no live stream
    "downloadFile": 404,
    "getImage": 404,  # no camera without ROS: tests/system/ros/camera_test.cc has one
}


def target_of(path, state):
    """An address of `path` that has an answer."""
    person = state["people"][0]
    target = path.format(person=person["character"], revision=person["revision"], number=0, name="S07_lift_001.mp4")
    if path == "/api/v1/series":
        keys = DESCRIPTION["components"]["schemas"]["SeriesKey"]["enum"][:24]
        target += f"?person={person['character']}&keys={','.join(keys)}&from=0&to=60000000000&columns=4"
    return target


def body_of(operation, state):
    if "requestBody" not in operation:
        return None
    media = operation["requestBody"]["content"]["application/json"]
    body = dict(media["example"])
    for problem in problems_of(body, media["schema"]):
        fail(f"the example of {operation['operationId']}: {problem}")
    if "state" in body:
        body["state"] = state["state_number"]
    return body


def check_roles(server, state):
    # What changes bodies is last: it makes their addresses old.
    for path, method, operation in sorted(operations(), key=lambda each: each[1]):
        name, target, body = operation["operationId"], target_of(path, state), body_of(operation, state)
        is_for_operators = any("operator" in roles for way in operation.get("security", []) for roles in way.values())
        for token in ("", "not-the-right-one"):
            expect(f"{name} with the token '{token}'", server, operation, 401, method, target, token, body)
        status = STATUS.get(name, 200)
        expect(f"{name} as viewer", server, operation, 403 if is_for_operators else status, method, target, VIEWER, body)
        expect(f"{name} as operator", server, operation, status, method, target, OPERATOR, body)


def check_errors(server, state):
    number = state["state_number"]
    for operation_path, method, target, body, status in [
            ("/api/v1/series", "GET", "/api/v1/series?person=0", None, 400),
            ("/api/v1/series", "GET", "/api/v1/series?person=9&keys=rate&from=0&to=1&columns=1", None, 404),
            ("/api/v1/marks", "GET", "/api/v1/marks?after=x", None, 400),
            ("/api/v1/mark", "POST", "/api/v1/mark", {"state": number}, 400),
            ("/api/v1/mark", "POST", "/api/v1/mark", {"state": number, "button": 1, "id": 1}, 400),
            ("/api/v1/mark", "POST", "/api/v1/mark", {"id": 99, "remove": True}, 409),
            ("/api/v1/mark", "POST", "/api/v1/mark", {"state": number + 1000000, "button": 1}, 409),
            ("/api/v1/hand_load", "POST", "/api/v1/hand_load", {}, 400),
            ("/api/v1/hand_load", "POST", "/api/v1/hand_load", {"right_kg": 101}, 400),
            ("/api/v1/hand_load", "POST", "/api/v1/hand_load", {"weight": 1}, 400),
            ("/api/v1/hand_load", "POST", "/api/v1/hand_load", {"right_kg": 1, "person": 9}, 404),
            ("/api/v1/skin/{person}/{revision}", "GET", "/api/v1/skin/0/99", None, 404),
            ("/api/v1/snapshot.png", "GET", "/api/v1/snapshot.png?width=15", None, 400),
            ("/api/v1/snapshot.png", "GET", "/api/v1/snapshot.png?camera=fron", None, 400),
            ("/api/v1/snapshot.png", "GET", f"/api/v1/snapshot.png?width=64&height=64&state={number}", None, 200),
            ("/api/v1/snapshot.png", "GET", f"/api/v1/snapshot.png?state={number + 1000000}", None, 409),
            ("/api/v1/ws", "GET", "/api/v1/ws", None, 426)]:
        operation = DESCRIPTION["paths"][operation_path][method.lower()]
        expect(f"{method} {target} {body or ''}", server, operation, status, method, target, OPERATOR, body)
        if str(status) not in operation["responses"]:
            fail(f"{operation['operationId']}: {status} is not described")
        if body is not None and status == 400:
            if not problems_of(body, operation["requestBody"]["content"]["application/json"]["schema"]):
                fail(f"{operation['operationId']}: the server rejects {body}, and the schema permits it")


def check_marks(server):
    """Points, spans and removed marks all have the described shape."""
    operation = DESCRIPTION["paths"]["/api/v1/mark"]["post"]

    def mark(body):
        for problem in problems_of(body, operation["requestBody"]["content"]["application/json"]["schema"]):
            fail(f"the body {body}: {problem}")
        return expect(f"the mark {body}", server, operation, 200, "POST", "/api/v1/mark", OPERATOR, body)

    number = json.loads(server.send("GET", "/api/v1/state")[2])["state_number"]
    span = mark({"state": number, "button": 2, "is_span": True})
    mark({"id": span["id"], "state": number})
    gone = mark({"state": number, "text": "slipped"})
    mark({"id": gone["id"], "remove": True})
    operation = DESCRIPTION["paths"]["/api/v1/marks"]["get"]
    marks = [mark for query in ("", "?after=1")  # removed ones are only told as changes
             for mark in expect("marks" + query, server, operation, 200, "GET", "/api/v1/marks" + query)["marks"]]
    kinds = {(each["end"] is not None, each["is_removed"]) for each in marks}
    if kinds != {(False, False), (True, False), (False, True)}:
        fail(f"expected a point, a span and a removed mark, got {kinds}")


def check_alarm(server):
    """An alarm is raised, a viewer sees it and may not acknowledge it, an operator does, and then it is acknowledged for all."""
    alarms, order = (DESCRIPTION["paths"][path][method] for path, method in
                     [("/api/v1/alarms", "get"), ("/api/v1/acknowledge", "post")])
    raised = server.wait_for("/api/v1/alarms", lambda answer: answer["alarms"])["alarms"][-1]
    if (raised["rule"], raised["is_shown"], raised["acknowledged"]) != ("always", True, None):
        fail(f"expected an alarm of the rule “always” that nobody has acknowledged, got {raised}")
    body = {"id": raised["id"]}
    expect("acknowledging as viewer", server, order, 403, "POST", "/api/v1/acknowledge", VIEWER, body)
    answer = expect("acknowledging", server, order, 200, "POST", "/api/v1/acknowledge", OPERATOR, body)
    expect("acknowledging again", server, order, 409, "POST", "/api/v1/acknowledge", OPERATOR, body)
    seen = expect("alarms as viewer", server, alarms, 200, "GET", "/api/v1/alarms", VIEWER)["alarms"]
    for each in [answer] + [alarm for alarm in seen if alarm["id"] == raised["id"]]:
        if (each["acknowledged"] or {}).get("role") != "operator" or not each["is_on"]:
            fail(f"expected an alarm that is on and that an operator has acknowledged, got {each}")


def check_parts():
    """People made of parts, without pictures."""
    with Server("--figure", "urdf", "--pictures", "off") as server:
        server.wait_for("/api/v1/state", lambda state: state["people"])
        model = expect("a model of parts", server, DESCRIPTION["paths"]["/api/v1/model"]["get"], 200, "GET", "/api/v1/model")
        meshes = [visual["mesh"] for person in model["people"] for link in person["links"] for visual in link["visuals"] if "mesh" in visual]
        if not meshes:
            fail("no mesh in the model")
        for mesh in meshes[:1]:
            expect(mesh, server, DESCRIPTION["paths"]["/api/v1/mesh/{person}/{revision}/{number}"]["get"], 200, "GET", mesh)
        operation = DESCRIPTION["paths"]["/api/v1/snapshot.png"]["get"]
        expect("a server without pictures", server, operation, 503, "GET", "/api/v1/snapshot.png")


ROBOT = tempfile.NamedTemporaryFile("w", suffix=".urdf")
ROBOT.write("<robot name='arm'><link name='base'><visual><geometry><box size='1 1 1'/></geometry></visual></link></robot>")
ROBOT.flush()
RULES = tempfile.NamedTemporaryFile("w", suffix=".yaml")
RULES.write("rules:\n  - {name: always, value: compression, above: 0}\n")
RULES.flush()
with Server("--robot", ROBOT.name, "--alarms", RULES.name) as server:
    state = server.wait_for("/api/v1/state", lambda state: state["people"] and state["liveness"] == "live")
    server.wait_for("/api/v1/diagnostics", lambda diagnostics: diagnostics.get("stream"))
    server.wait_until_found("/api/v1/surroundings.glb")
    check_roles(server, state)
    check_errors(server, state)
    check_marks(server)
    check_alarm(server)
check_parts()
print(f"{len(list(operations()))} operations checked, {failed} problems")
sys.exit(1 if failed else 0)
