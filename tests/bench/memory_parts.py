#!/usr/bin/env python3
"""Prints the resident memory of a program by kind of mapping, at the moment at which it has most.

Usage: memory_parts.py COMMAND...       until it ends
       memory_parts.py --pid PID SECS   of a server, for so long

files: the program and its libraries, as far as they are in memory; other processes may share them.
large: blocks of 8 MiB or more, which are textures, pictures of 4K, and heaps of threads. rest: smaller ones.
Samples 20 times per second, so that short peaks may be missed; `/usr/bin/time -v` has the exact peak of the sum.
"""
import subprocess
import sys
import time

LARGE_KIB = 8 * 1024


def read_parts(pid):
    """KiB by kind; None when the process has ended."""
    parts = {"files": 0, "large": 0, "rest": 0}
    try:
        with open(f"/proc/{pid}/smaps", encoding="utf-8", errors="replace") as smaps:
            is_file, size = False, 0
            for line in smaps:
                words = line.split()
                if not words[0].endswith(":"):
                    is_file = len(words) > 5 and words[5].startswith("/")
                elif words[0] == "Size:":
                    size = int(words[1])
                elif words[0] == "Rss:":
                    kind = "files" if is_file else "large" if size >= LARGE_KIB else "rest"
                    parts[kind] += int(words[1])
    except (FileNotFoundError, ProcessLookupError):
        return None
    return parts


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    child, pid, end = None, None, float("inf")
    if sys.argv[1] == "--pid":
        pid, end = int(sys.argv[2]), time.monotonic() + float(sys.argv[3])
    else:
        child = subprocess.Popen(sys.argv[1:], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        pid = child.pid
    most = {}
    while time.monotonic() < end and (child is None or child.poll() is None):
        parts = read_parts(pid)
        if parts is None:
            break
        if sum(parts.values()) > sum(most.values()):
            most = parts
        time.sleep(0.05)
    print(", ".join([f"{sum(most.values()) / 1024:.0f} MB"] + [f"{kind} {kib / 1024:.0f}" for kind, kib in most.items()]))
    if child is not None and child.wait() != 0:
        sys.exit(f"exit status {child.returncode}")


main()
