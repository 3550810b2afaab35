#!/usr/bin/env python3
"""How long `kinescope serve` takes to start, and to end after Ctrl-C, beside a ROS master that accepts connections and freezes
after a number of calls. A proxy passes the calls to a real rosmaster until then.
    tests/bench/frozen_master.py KINESCOPE [CALLS ...]"""
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time


class FreezingMaster:
    """Passes `calls` calls on to the master at `port`; from then on it accepts and does not answer."""

    def __init__(self, port, calls):
        self.port, self.left, self.sockets = port, calls, []
        self.listener = socket.create_server(("127.0.0.1", 0), backlog=64)
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        while True:
            client, _ = self.listener.accept()
            self.sockets.append(client)
            if self.left <= 0:
                continue
            master = socket.create_connection(("127.0.0.1", self.port))
            for one, other, counts in ((client, master, True), (master, client, False)):
                threading.Thread(target=self.pass_on, args=(one, other, counts), daemon=True).start()

    def pass_on(self, one, other, counts):
        try:
            while data := one.recv(65536):
                if counts and b"POST " in data:
                    self.left -= 1
                if self.left < 0:
                    return
                other.sendall(data)
            other.shutdown(socket.SHUT_WR)
        except OSError:
            pass  # one side has gone


def measure(kinescope, port, calls):
    master = FreezingMaster(port, calls)
    environment = dict(os.environ, ROS_MASTER_URI=f"http://127.0.0.1:{master.listener.getsockname()[1]}", ROS_IP="127.0.0.1")
    begin = time.monotonic()
    server = subprocess.Popen([kinescope, "serve", "demo:walk", "--http_port", "0", "--picture_size", "320x180"],
                              env=environment, stderr=subprocess.PIPE, text=True)
    next(line for line in server.stderr if "page at" in line)
    started = time.monotonic() - begin
    time.sleep(2.5)  # so that it is registering, or waits for an answer
    begin = time.monotonic()
    server.send_signal(signal.SIGINT)
    server.wait(timeout=60)
    print(f"answers {calls} calls: page after {started:.2f} s, ended {time.monotonic() - begin:.2f} s after Ctrl-C", flush=True)


def main(kinescope, *calls):
    with tempfile.TemporaryDirectory() as folder, socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
        free.close()
        master = subprocess.Popen(["rosmaster", "--core", "-p", str(port)], env=dict(os.environ, ROS_HOME=folder, ROS_IP="127.0.0.1"),
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while True:
            try:
                socket.create_connection(("127.0.0.1", port)).close()
                break
            except OSError:
                time.sleep(0.1)
        for number in calls or (0, 1, 2, 3, 5, 8, 12, 20, 30, 40, 60):
            measure(kinescope, port, int(number))
        master.kill()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
