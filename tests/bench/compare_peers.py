#!/usr/bin/python3
"""Compares `kinescope golden compare` with other programs that compare pictures, in one run on the same files.
Usage: compare_peers.py PEERS [BUILD [ROUNDS]]

PEERS: a folder in which `npm install pixelmatch odiff-bin` was run. BUILD: default build/dev. ROUNDS: default 15.
ImageMagick's compare is that of Debian. The first table says which mutations of a rendered picture of 1280x720 each program tells apart,
with its settings for tests: pixelmatch and odiff at a threshold of 0.1 with detection of anti-aliasing, ImageMagick once exact and once
with -fuzz 2%. The second has the time of a whole process, which reads two files: in each round every program runs once, and the
median of the rounds counts.
"""
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

TOP = pathlib.Path(__file__).resolve().parents[2]
peers = pathlib.Path(sys.argv[1]).resolve()
build = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else TOP / "build/dev").resolve()
rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 15
KINESCOPE = str(build / "bin/kinescope")
ODIFF = str(next(peers.glob("node_modules/@odiff/linux-*/odiff")))  # not its wrapper, which is a script of Node
PIXELMATCH = str(peers / "node_modules/pixelmatch/bin/pixelmatch")
SCENE = ["demo:lift", "--time", "2", "--size", "1280x720"]
CAMERA = "0.3,-3.4,1.1:0.3,0,0.8"
TURNED = "0.3297,-3.3999,1.1:0.3,0,0.8"  # by 0.5 degrees about the target

PROGRAMS = {
    "Kinescope": lambda a, b: [KINESCOPE, "golden", "compare", a, b],
    "pixelmatch": lambda a, b: ["node", PIXELMATCH, a, b],
    "odiff": lambda a, b: [ODIFF, "--antialiasing", "--threshold", "0.1", a, b],
    "IM exact": lambda a, b: ["/usr/bin/compare", "-metric", "AE", a, b, "null:"],
    "IM 2 %": lambda a, b: ["/usr/bin/compare", "-metric", "AE", "-fuzz", "2%", a, b, "null:"],
}


def render(folder, name, *options):
    file = str(folder / f"{name}.png")
    subprocess.run([KINESCOPE, "render", *SCENE, "--out", file, "--no_sidecar", *options], check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    return file


def rendered_pairs(folder):
    expected = render(folder, "rendered", "--camera", CAMERA)
    for name, options in [("CoP hidden", ["--hide", "cop"]), ("one load class changed", ["--class_limits", "0.3,0.75"]),
                          ("floor off", ["--floor", "off"]), ("camera 0.5 degrees off", ["--camera", TURNED])]:
        options = options if "--camera" in options else ["--camera", CAMERA, *options]
        yield expected, render(folder, name.replace(" ", "_"), *options), True, name


def mutated_pairs(folder):
    listing = subprocess.run([str(build / "tests/bench/picture_pairs"), render(folder, "front"), str(folder)], check=True, text=True,
                             stdout=subprocess.PIPE).stdout
    expected = str(folder / "expected.png")
    for line in listing.splitlines():
        file, must_differ, name = line.split("\t")
        yield expected, file, must_differ == "1", name
    other = str(folder / "other.png")
    subprocess.run(["/usr/bin/convert", expected, "-quality", "95", other], check=True)
    yield expected, other, False, "other PNG compression"


def run(words):
    start = time.perf_counter()
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    return (time.perf_counter() - start) * 1e3, done


def main():
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work)
        pairs = list(rendered_pairs(folder)) + list(mutated_pairs(folder))
        model = next(line.split(": ")[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8") if line.startswith("model name"))
        print(f"machine: {model}, load {open('/proc/loadavg', encoding='utf-8').read().split()[0]}, {rounds} rounds\n")
        print("| pair | must differ |", " | ".join(PROGRAMS), "|\n|---|---|" + "---|" * len(PROGRAMS))
        wrong = dict.fromkeys(PROGRAMS, 0)
        for a, b, must_differ, name in pairs:
            cells = []
            for program, command in PROGRAMS.items():
                differs = run(command(a, b))[1].returncode != 0
                wrong[program] += differs != must_differ
                cells.append(("differs" if differs else "same") + ("" if differs == must_differ else " **wrong**"))
            print(f"| {name} | {'yes' if must_differ else 'no'} |", " | ".join(cells), "|")
        print("| wrong verdicts | |", " | ".join(str(count) for count in wrong.values()), "|\n")

        timed = [pair for pair in pairs if pair[3] in ("CoP hidden", "sphere moved by 3 px", "1 % darker", "camera 0.5 degrees off", "all moved by 1 px")]
        timed.append((pairs[0][0], pairs[0][0], False, "one file twice"))
        print("| ms, median (least) |", " | ".join(PROGRAMS), "|\n|---|" + "---|" * len(PROGRAMS))
        for a, b, _, name in timed:
            times = {program: [] for program in PROGRAMS}
            for _ in range(rounds):
                for program, command in PROGRAMS.items():
                    times[program].append(run(command(a, b))[0])
            print(f"| {name} |", " | ".join(f"{statistics.median(t):.1f} ({min(t):.1f})" for t in times.values()), "|")
        starts = [run([KINESCOPE, "--version"])[0] for _ in range(rounds)]
        print(f"\nkinescope --version: {statistics.median(starts):.1f} ms ({min(starts):.1f})")


main()
