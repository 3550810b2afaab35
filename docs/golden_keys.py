#!/usr/bin/python3
"""Writes docs/golden_keys.md: the keys of a golden case, as the program lists them. Usage: golden_keys.py PROGRAM > docs/golden_keys.md"""
import json
import subprocess
import sys

lines = subprocess.run([sys.argv[1], "golden", "keys", "--json"], check=True, capture_output=True, text=True).stdout.splitlines()
print("# Keys of a golden case")
print()
print("What [a case](golden.md) may say, one `key: value` per line. `kinescope golden keys` prints the same; docs/golden_keys.py makes this page")
print("from it.")
print()
print("| key | default | meaning | values |")
print("|---|---|---|---|")
for line in lines:
    key = json.loads(line)
    default = key["default"]
    text = "" if default in (None, "", []) else default if isinstance(default, str) else json.dumps(default)
    cells = [f"`{key['key']}`", f"`{text}`" if text else "", key["about"], key["expected"]]
    print("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
