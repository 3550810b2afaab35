"""Remembers which files have passed a check, by what they contain.

A file that has passed need not be checked again until it, or what the check reads with it, has changed: in any clone, on any branch.
The memory is a file of hashes in the cache folder of the user. Without it everything is checked.
"""
import hashlib
import os
import pathlib

MOST_KEPT = 40000  # lines of 65 bytes


def key_of(*parts):
    """Of texts and bytes."""
    digest = hashlib.sha256()
    for part in parts:
        data = part if isinstance(part, bytes) else str(part).encode()
        digest.update(len(data).to_bytes(8, "little") + data)
    return digest.hexdigest()


class Passed:
    def __init__(self, check):
        cache = os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache"
        self._path = pathlib.Path(cache) / "kinescope" / f"{check}.passed"
        try:
            self._keys = set(self._path.read_text().split())
        except (OSError, UnicodeDecodeError):
            self._keys = set()

    def __contains__(self, key):
        return key in self._keys

    def add(self, keys):
        """Whole lines only, so that two runs may add at a time; a folder that is not writable costs the memory and nothing else."""
        new = sorted(set(keys) - self._keys)
        if not new:
            return
        self._keys.update(new)
        try:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            if len(self._keys) > MOST_KEPT:
                self._path.unlink(missing_ok=True)  # what passes from now on is remembered
                self._keys = set(new)
            with open(self._path, "a", encoding="ascii") as file:
                file.write("".join(f"{key}\n" for key in new))
        except OSError:
            pass
