#!/usr/bin/python3
"""The arrows of ARCHITECTURE.md, checked: which folder may include which, and whose types stay where."""
import pathlib
import re
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent
ALLOWED = {  # folder: folders of ours that it may include
    "urdf": set(),
    "server/core": {"urdf"},
    "server/mvn": {"server/core", "urdf"},
    "server/subject": {"server/core", "urdf"},
    "server/loads": {"server/core", "urdf"},
    "server/ros": {"server/core", "urdf"},
    "server/http": {"server/core", "urdf"},
    "render": {"server/core", "urdf"},
    "server/app": {"server/core", "server/mvn", "server/subject", "server/loads", "server/ros",
                   "server/http", "render", "urdf"},
}
FOREIGN = {  # whose headers: where they may be included
    r"vtk": ("render/vtk",),
    r"(ros|rosbag|kinescope|tf2|tf2_msgs|std_msgs|sensor_msgs|geometry_msgs|visualization_msgs|image_transport|xmlrpcpp)/": ("server/ros",),
    r"boost/": ("server/http", "server/ros"),
    r"lib(av|sw)": ("render",),
    r"cairo": ("render/plot",),
    r"pcap": ("server/mvn",),
    r"expat": ("server/mvn", "urdf"),
    r"archive": ("server/core",),
    r"nettle/": ("server/core",),
    r"webp/": ("render/av",),
    r"(urdf_parser|urdf_model)/": ("urdf",),
    r"assimp/": ("render/vtk",),
    r"(GL|EGL)/": ("render/vtk",),
}


def folder_of(path):
    return max((f for f in ALLOWED if path.startswith(f + "/")), key=len, default=None)


problems = []
seen = 0
for folder in ALLOWED:
    for file in sorted((TOP / folder).rglob("*")):
        name = file.relative_to(TOP).as_posix()
        if file.suffix not in (".h", ".cc") or folder_of(name) != folder:
            continue
        for number, line in enumerate(file.read_text().splitlines(), 1):
            include = re.match(r'\s*#\s*include\s*([<"])(.+)[>"]', line)
            if not include:
                continue
            seen += 1
            target = include.group(2)
            if include.group(1) == '"':
                other = folder_of(target)
                if other and other != folder and other not in ALLOWED[folder]:
                    problems.append(f"{name}:{number}: {folder} may not include {target}")
            for pattern, homes in FOREIGN.items():
                if re.match(pattern, target) and not name.startswith(tuple(h + "/" for h in homes)):
                    problems.append(f"{name}:{number}: {target} belongs into {' or '.join(homes)}")
print(f"{seen} includes looked at, {len(problems)} in the wrong place", *problems, sep="\n")
sys.exit(bool(problems) or seen == 0)
