#!/usr/bin/env python3
"""exact_arithmetic_test.py FOLDER PROGRAM...: in the programs and the modules of the folder is no instruction whose result depends on the make of the processor.

RSQRT and RCP are estimates, of which AMD and Intel have their own. A picture that is computed with them has other bytes on another
machine, which `golden check --strict` takes for a change of the program.
"""
import pathlib
import re
import subprocess
import sys

ESTIMATE = re.compile(r"\tv?(rsqrt|rcp)(14|28)?(ss|ps|sd|pd)\b")
FUNCTION = re.compile(r"^[0-9a-f]+ <(.*)>:$")


def estimates_in(path):
    """Functions of the file that have such an instruction."""
    listing = subprocess.run(["objdump", "--disassemble", "--demangle", "--no-show-raw-insn", path], check=True,
                             stdout=subprocess.PIPE, text=True).stdout
    function, found, instructions = "", set(), 0
    for line in listing.splitlines():
        if begin := FUNCTION.match(line):
            function = begin.group(1)
        elif ESTIMATE.search(line):
            found.add(function)
        instructions += 1
    if instructions < 1000:
        sys.exit(f"{path}: has only {instructions} lines of code; is it the program?")
    return sorted(found)


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
