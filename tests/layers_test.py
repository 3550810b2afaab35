#!/usr/bin/python3
"""Checks the includes between folders. The table "Folders" in ARCHITECTURE.md lists the folders that each
folder may include. A row "part of X" describes a folder that X, and every folder that may include X, may include
too. LIBRARIES below lists the folders that may include the headers of a third-party library, so
that its types stay there. Both lists are exact: an entry that no include needs is an error too, so the lists
cannot become outdated.

Types of one namespace have different names: two of one name link, and then one takes the place of the other.

Run without arguments; exit code 1 if an include is not allowed or an entry is not needed. The script also tests
itself: it inserts faults into a copy of the sources in memory and must report them.
"""
import pathlib
import re
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent
SOURCES = (".h", ".hh", ".hpp", ".c", ".cc", ".cpp", ".cxx")
NOT_OURS = {"build", "node_modules"}  # and hidden folders

# Single files that may include more than their folder, and the reason. Also exact.
EXCEPTIONS = {
    "server/mvn/open.cc": {"server/mvn/net", "server/mvn/file"},  # opens every kind of URL
}

# Third-party headers, by the beginning of their name: the library and the folders that may include them ("/*": all subfolders).
LIBRARIES = {
    r"CGAL/": ("CGAL", {"urdf/skin/make"}),
    r"Eigen/": ("Eigen", {"urdf", "urdf/mesh", "urdf/rig", "urdf/robot", "urdf/skin", "urdf/skin/make", "core", "server/mvn", "server/subject",
                          "server/loads", "server/wrenches", "server/ros", "server/http", "server/body", "server/picture",
                          "render/camera", "render/shape", "render/vtk"}),
    r"fmt/": ("fmt", {"server/alarms", "server/download", "urdf", "urdf/rig", "urdf/robot", "server/loads", "server/mvn/file", "server/options", "server/body",
                      "server/scene", "server/picture", "server/table", "server/wrenches", "server/app", "server/app/*", "render",
                      "render/image", "render/plot"}),
    r"spdlog/": ("spdlog", {"server/mvn/net", "server/mvn/file", "server/ros", "server/ros/source", "server/body", "server/scene",
                            "server/picture", "server/app", "server/app/*"}),
    r"tl/expected": ("libexpected", {"server/mvn", "server/mvn/file", "server/alarms", "server/marks", "server/http", "server/picture", "server/ros", "server/app/*", "render/image"}),
    r"nlohmann/": ("nlohmann-json", {"core/system", "server/alarms", "server/http", "server/marks", "server/recording", "render/shape", "urdf/mesh", "urdf/rig", "server/options", "server/source", "server/picture", "server/app", "server/app/*"}),
    r"CLI/": ("CLI11", {"server/app"}),
    r"yaml-cpp/": ("yaml-cpp", {"server/alarms", "server/options", "server/picture"}),
    r"(urdf_parser|urdf_model)/": ("urdfdom", {"urdf/robot"}),
    r"console_bridge/": ("console_bridge", {"urdf/robot", "server/ros"}),
    r"expat\.h": ("expat", {"urdf/robot", "server/mvn/file"}),
    r"curl/": ("libcurl", {"server/alarms", "server/download"}),
    r"archive(_entry)?\.h": ("libarchive", {"core/system"}),
    r"nettle/": ("nettle", {"core/system"}),
    r"pcap/|pcap\.h": ("libpcap", {"server/mvn/file"}),
    r"boost/": ("Boost.Beast", {"server/http"}),
    r"openssl/": ("OpenSSL", {"server/http"}),
    r"image_transport/": ("image_transport", {"server/ros"}),
    r"tf2(_msgs)?/": ("tf2", {"server/ros", "server/ros/source"}),
    r"(ros|xmlrpcpp|kinescope|\w+_msgs|std_srvs|dynamic_reconfigure)/": ("roscpp and messages", {"server/ros", "server/ros/source"}),
    r"diagnostic_updater/": ("diagnostic_updater", {"server/ros"}),
    r"interactive_markers/": ("interactive_markers", {"server/ros"}),
    r"libdeflate\.h": ("libdeflate", {"render/image"}),
    r"png\.h": ("libpng", {"render/image"}),
    r"jpeglib\.h": ("libjpeg-turbo", {"render/image"}),
    r"zlib\.h": ("zlib", {"render"}),
    r"zstd\.h": ("zstd", {"server/history"}),
    r"ft2build\.h|freetype/": ("FreeType", {"render"}),
    r"glm/": ("GLM", {"render/camera", "render/vtk"}),
    r"lib(av|sw)\w+/": ("libav", {"render/av"}),
    r"webp/": ("libwebp", {"render/av"}),
    r"cairo/|cairo[\w-]*\.h": ("Cairo", {"render/plot"}),
    r"vtk\w+\.h": ("VTK", {"render/vtk"}),
    r"(GL|EGL)/": ("VTK", {"render/vtk"}),  # OpenGL, as used by VTK, and EGL
    r"assimp/": ("assimp", {"urdf/mesh"}),
    r"meshoptimizer\.h": ("meshoptimizer", {"render/shape", "urdf/skin/make"}),
}
STANDARD = re.compile(r"[a-z_]+$|(stdlib|stdio|string|math|errno|time|signal|limits)\.h$")
SYSTEM = re.compile(r"(sys|netinet|arpa|linux)/|(dlfcn|fcntl|glob|malloc|netdb|poll|pwd|sched|spawn|unistd|pthread)\.h$")

INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')


def read_tree():
    """Every source of the project and ARCHITECTURE.md: path from the top folder -> text."""
    tree = {"ARCHITECTURE.md": (TOP / "ARCHITECTURE.md").read_text()}
    folders = [TOP]
    while folders:
        for entry in folders.pop().iterdir():
            if entry.is_dir() and not entry.is_symlink():
                if entry.name not in NOT_OURS and not entry.name.startswith("."):
                    folders.append(entry)
            elif entry.suffix in SOURCES:
                tree[entry.relative_to(TOP).as_posix()] = entry.read_text()
    return tree


def folder_of(name):
    return name.rpartition("/")[0]


def read_arrows(architecture):
    """The table: folder -> folders that it may include; None: all folders."""
    arrows = {}
    table = re.search(r"\| folder \| holds \| may include \|\n.*\n((?:\|.*\n)+)", architecture)
    for row in table.group(1).splitlines() if table else ():
        cells = row.strip("| ").split(" | ")
        folder = cells[0].strip("` /")
        arrows[folder] = None if cells[-1] == "all" else set(re.findall(r"`([^`]+?)/?`", cells[-1]))
    return arrows


def read_parts(architecture):
    """Folder -> the folder that it is a part of."""
    return {part: whole for part, whole in re.findall(r"\| `([^`]+)/` \| part of `([^`]+)`:", architecture)}


def check(tree):
    """(number of checked includes, list of problems, one line each)"""
    problems = []
    arrows = read_arrows(tree["ARCHITECTURE.md"])
    parts = read_parts(tree["ARCHITECTURE.md"])
    if not arrows:
        return 0, ['ARCHITECTURE.md: no table "folder | holds | may include"']
    dependencies = tree["ARCHITECTURE.md"].partition("\n## Dependencies")[2]
    for library in sorted({library for library, _ in LIBRARIES.values()}):
        if library not in dependencies:
            problems.append(f"ARCHITECTURE.md: {library} is not among the dependencies")
    seen = 0
    used_arrows, used_exceptions, used_homes = set(), set(), set()
    for name, text in sorted(tree.items()):
        if name == "ARCHITECTURE.md":
            continue
        folder = folder_of(name)
        if folder == "tests" or folder.startswith("tests/"):
            continue  # may include all folders, and mirrors them
        if folder not in arrows:
            problems.append(f"{name}: the folder '{folder}' is not in ARCHITECTURE.md's table")
            continue
        for number, line in enumerate(text.splitlines(), 1):
            include = INCLUDE.match(line)
            if not include:
                continue
            seen += 1
            where, target = f"{name}:{number}", include.group(2)
            if include.group(1) == '"':
                other = folder_of(target)
                whole = parts.get(other, other)
                if target not in tree:
                    problems.append(f"{where}: {target} not found; expected a path from the top folder")
                elif other == folder or whole == folder or arrows[folder] is None:
                    pass
                elif other in arrows[folder]:
                    used_arrows.add((folder, other))
                elif whole in arrows[folder]:
                    used_arrows.add((folder, whole))
                elif other in EXCEPTIONS.get(name, ()):
                    used_exceptions.add((name, other))
                else:
                    problems.append(f"{where}: {folder} may not include {target}")
            elif not (STANDARD.match(target) or SYSTEM.match(target)):
                found = next((p for p in LIBRARIES if re.match(p, target)), None)
                if found is None:
                    problems.append(f"{where}: {target} belongs to no library in tests/layers_test.py")
                elif folder in LIBRARIES[found][1]:
                    used_homes.add((found, folder))
                elif folder_of(folder) + "/*" in LIBRARIES[found][1]:
                    used_homes.add((found, folder_of(folder) + "/*"))
                else:
                    homes = " or ".join(sorted(LIBRARIES[found][1]))
                    problems.append(f"{where}: {target} may only be included in {homes}")
    for folder, others in arrows.items():
        for other in sorted(others or ()):
            if (folder, other) not in used_arrows:
                problems.append(f"ARCHITECTURE.md: nothing in {folder} includes {other}")
    for name, others in EXCEPTIONS.items():
        for other in sorted(others):
            if (name, other) not in used_exceptions:
                problems.append(f"tests/layers_test.py: {name} does not include {other}")
    for pattern, (_, homes) in LIBRARIES.items():
        for home in sorted(homes):
            if (pattern, home) not in used_homes:
                problems.append(f"tests/layers_test.py: nothing in {home} includes {pattern}")
    return seen, problems


def types_of_one_name(tree):
    """Lines for types of one namespace that two headers define: they link, and then one takes the place of the other."""
    first, problems = {}, []
    for name in sorted(n for n in tree if n.endswith(".h") and not n.startswith("tests/")):
        namespace = None
        for line in tree[name].splitlines():
            if match := re.match(r"namespace (kinescope[\w:]*) \{", line):
                namespace = match[1]
            elif match := re.match(r"(?:struct|class|enum class) (\w+)[^;]*\{", line):
                known = first.setdefault((namespace, match[1]), name)
                if known != name:
                    problems.append(f"{name}: {namespace}::{match[1]} is also in {known}; choose another name")
    return problems


def faults_not_found(tree):
    """Inserts faults of every kind into a copy; returns the lines that check() should report and does not, and those it should not."""
    faulty = dict(tree)
    expected = set(check(tree)[1])

    def include(name, line, *problems):
        text = faulty.get(name, "")
        faulty[name] = text + line + "\n"
        number = len(text.splitlines()) + 1
        expected.update(problem.format(f"{name}:{number}") for problem in problems)

    include("core/system/clocks.h", '#include "server/app/progress.h"',
            "{}: core/system may not include server/app/progress.h")
    include("server/app/loads/svg.h", '#include "server/app/render/provenance.h"',
            "{}: server/app/loads may not include server/app/render/provenance.h")
    include("server/app/loads/svg.h", "#include <CLI/CLI.hpp>",
            "{}: CLI/CLI.hpp may only be included in server/app")
    include("render/image/image.h", '#  include "render/vtk/ground.h"  // indented',
            "{}: render/image may not include render/vtk/ground.h")
    include("server/mvn/assembler.h", '#include "server/mvn/net/socket.h"',
            "{}: server/mvn may not include server/mvn/net/socket.h")
    include("server/mvn/net/socket.h", '#include "server/mvn/file/packet.h"',
            "{}: server/mvn/net may not include server/mvn/file/packet.h")
    include("render/image/png_file.cc", "#include <libavutil/error.h>",
            "{}: libavutil/error.h may only be included in render/av")
    include("server/mvn/tally.h", "#include <pcap/pcap.h>",
            "{}: pcap/pcap.h may only be included in server/mvn/file")
    include("server/http/hub.h", "#include <ros/ros.h>", "{}: ros/ros.h may only be included in server/ros or server/ros/source")
    include("urdf/body_surface.h", "#include <range/v3/all.hpp>",
            "{}: range/v3/all.hpp belongs to no library in tests/layers_test.py")
    include("render/vtk/ground.h", '#include "tests/temp_folder.h"',
            "{}: render/vtk may not include tests/temp_folder.h")
    include("server/loads/ground.h", '#include "ground.h"',
            "{}: ground.h not found; expected a path from the top folder")
    faulty["server/news/feed.cc"] = "#include <vector>\n"
    expected.add("server/news/feed.cc: the folder 'server/news' is not in ARCHITECTURE.md's table")
    faulty["server/mvn/open.cc"] = ""
    expected |= {"tests/layers_test.py: server/mvn/open.cc does not include server/mvn/net",
                 "tests/layers_test.py: server/mvn/open.cc does not include server/mvn/file"}
    for name in [n for n in faulty if folder_of(n) == "server/subject"]:
        faulty[name] = re.sub(r'#include "urdf/.*', "", faulty[name])
    expected.add("ARCHITECTURE.md: nothing in server/subject includes urdf")
    for name in [n for n in faulty if folder_of(n) == "core/system"]:
        faulty[name] = re.sub(r"#include <nettle/.*", "", faulty[name])
    expected.add("tests/layers_test.py: nothing in core/system includes nettle/")
    faulty["ARCHITECTURE.md"] = faulty["ARCHITECTURE.md"].replace("| libpcap |", "| capture library |")
    expected.add("ARCHITECTURE.md: libpcap is not among the dependencies")
    faulty["server/mvn/feed.h"] = "namespace kinescope::mvn {\nstruct Feed {\n};\n}\n"
    faulty["server/mvn/net/feed.h"] = "namespace kinescope::mvn {\nclass Feed : public Base {\n};\n}\n"
    expected.add("server/mvn/net/feed.h: kinescope::mvn::Feed is also in server/mvn/feed.h; choose another name")
    found = set(check(faulty)[1] + types_of_one_name(faulty))
    return ([f"self-test: not reported: {line}" for line in sorted(expected - found)] +
            [f"self-test: reported wrongly: {line}" for line in sorted(found - expected)])


def main():
    tree = read_tree()
    seen, problems = check(tree)
    problems += types_of_one_name(tree) + faults_not_found(tree)
    print(f"{seen} includes checked, {len(problems)} problems", *problems, sep="\n")
    return 1 if problems or seen == 0 else 0


sys.exit(main())
