"""Compiler options of each folder in a build, for the checks that compile single files."""
import collections
import json
import pathlib
import re
import resource
import shlex

TOP = pathlib.Path(__file__).resolve().parent.parent
INCLUDE = re.compile(r'[ \t]*#[ \t]*include[ \t]*([<"])([^>"\n]+)[>"]')


def sources_of(entry):
    """The sources that an entry of the database compiles; a batch of a unity build has several."""
    source = pathlib.Path(entry["directory"], entry["file"])
    if source.parent.name != "batches":  # of cmake/batches.cmake
        return [source]
    return [TOP / m.group(2) for m in map(INCLUDE.match, source.read_text().splitlines()) if m]


def read_flags(build):
    """Folder of sources -> include paths and definitions of the targets with sources in it."""
    flags = collections.defaultdict(dict)  # an ordered set
    for entry in json.loads((build / "compile_commands.json").read_text()):
        words = entry.get("arguments") or shlex.split(entry["command"])
        taken = []
        for word, following in zip(words, words[1:] + [""]):
            if word in ("-I", "-isystem", "-D"):
                taken.append((word, following))
            elif word[:2] in ("-I", "-D"):
                taken.append((word,))
        for source in sources_of(entry):
            if TOP in source.parents:
                flags[source.parent.relative_to(TOP).as_posix()].update(dict.fromkeys(taken))
    return {folder: [word for words in taken for word in words] for folder, taken in flags.items()}


def flags_for(flags, name):
    """Options for the folder of the header, or for the nearest folder above it that has sources."""
    for folder in pathlib.PurePosixPath(name).parents:
        if folder.as_posix() in flags:
            return flags[folder.as_posix()]
    return None


def cpu_seconds():
    return sum(resource.getrusage(who).ru_utime + resource.getrusage(who).ru_stime
               for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
