#!/usr/bin/env python3
"""exact_arithmetic_test.py FOLDER PROGRAM...: no instruction of the programs, and of the modules in the folder, depends on the make of the processor.

RSQRT and RCP are estimates, of which AMD and Intel have their own. A picture that is computed with them has other bytes on another
machine, which `golden check --strict` takes for a change of the program.
"""
import pathlib
import re
import subprocess
import sys

ESTIMATE = re.compile(rb"\tv?(rsqrt|rcp)(14|28)?(ss|ps|sd|pd)\b")


def estimates_in(path):
    """Functions of the file that have such an instruction."""
    listing = subprocess.run(["objdump", "--disassemble", "--no-show-raw-insn", path], check=True, stdout=subprocess.PIPE).stdout
    lines = listing.count(b"\n")
    if lines < 1000:
        sys.exit(f"{path}: has only {lines} lines of code; is it the program?")
    found = set()
    for hit in ESTIMATE.finditer(listing):
        end = listing.rfind(b">:\n", 0, hit.start())
        found.add(listing[listing.rfind(b"<", 0, end) + 1:end].decode())
    names = subprocess.run(["c++filt"], check=True, input="\n".join(sorted(found)), stdout=subprocess.PIPE, text=True).stdout
    return names.splitlines()


def main():
    """Returns the exit code."""
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    folder, programs = pathlib.Path(sys.argv[1]), sys.argv[2:]
    modules, count = sorted(folder.glob("*.so")), 0
    if not modules:
        sys.exit(f"{folder}: has no modules")
    for path in [*programs, *modules]:
        for function in estimates_in(path):
            count += 1
            print(f"{path}: {function}: computes with an estimate of the processor; use sqrt and a division")
    return min(count, 1)


if __name__ == "__main__":
    sys.exit(main())
