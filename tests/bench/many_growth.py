#!/usr/bin/python3
"""What many trials cost: batches by processes and jobs, recordings by length, a server by people and viewers.
Usage: many_growth.py BUILD [--figure FILE.svg] [--only PART]    PART: processes, jobs, minutes, people or viewers

Takes about fifteen minutes on an idle machine. Prints Markdown tables; gnuplot (package gnuplot-nox) draws the figure."""
import argparse
import json
import os
import pathlib
import re
import socket
import subprocess
import sys
import tempfile
import time

TICKS = os.sysconf("SC_CLK_TCK")


class Cost:
    """Wall and CPU seconds of a command and its processes, and the most memory that one of them had."""

    def __init__(self, command, folder):
        start = time.monotonic()
        process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        errors = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        if status != 0:
            sys.exit(f"{' '.join(map(str, command))}: {errors}")
        self.wall = time.monotonic() - start
        self.cpu = usage.ru_utime + usage.ru_stime
        self.megabytes = usage.ru_maxrss / 1024


def table(title, head, rows):
    print(f"\n{title}\n\n| " + " | ".join(head) + " |\n|" + "---|" * len(head))
    for row in rows:
        print("| " + " | ".join(f"{value:.3g}" if isinstance(value, float) and value < 100 else f"{value:.0f}" if isinstance(value, float)
                                else str(value) for value in row) + " |", flush=True)
    print(flush=True)


class Growth:
    def __init__(self, build, folder):
        self.kinescope = build / "bin/kinescope"
        self.viewers_program = build / "tests/bench/page_viewers"
        self.folder = folder
        self.series = {}  # name of a panel -> (axis, [(x, {line: y})])

    def batch(self, count, at_once, job):
        lines = [json.dumps({"id": f"{i:04}", **job(i)}) for i in range(count)]
        (self.folder / "jobs.jsonl").write_text("\n".join(lines) + "\n")
        (self.folder / "jobs.results.jsonl").unlink(missing_ok=True)
        cost = Cost([self.kinescope, "batch", "jobs.jsonl", "--jobs", str(at_once)], self.folder)
        results = [json.loads(line) for line in (self.folder / "jobs.results.jsonl").read_text().splitlines()]
        cost.jobs = sum(result["seconds"] for result in results)
        cost.of_jobs = sum(result["cpu_seconds"] for result in results)
        cost.megabytes = max(result["peak_memory_bytes"] for result in results) / 2**20
        return cost

    @staticmethod
    def clip(i):
        """Two seconds at the size of a clip's default."""
        return {"command": "render", "options": {"source": "demo:walk", "seconds": 2, "out": f"{i:04}.mp4", "force": True}}

    @staticmethod
    def loads(i):
        return {"command": "loads", "options": {"source": "demo:lift", "seconds": 2, "samples": "none", "json": f"{i:04}.json"}}

    def processes(self):
        rows = []
        for at_once in (1, 2, 4):
            clips, loads = self.batch(16, at_once, self.clip), self.batch(400, at_once, self.loads)
            rows.append((at_once, clips.wall, clips.cpu, clips.megabytes, loads.wall, loads.cpu, loads.megabytes))
        table("16 clips of 2 s (1280x720, 2x supersampled) and 400 files of loads of 2 s, by processes:",
              ("processes", "clips: wall, s", "CPU, s", "MB", "loads: wall, s", "CPU, s", "MB"), rows)
        self.series["processes"] = ("processes", [(row[0], {"clips, wall s": row[1], "clips, CPU s": row[2]}) for row in rows])
        return rows

    def jobs(self):
        rows = []
        for count in (1, 10, 100, 1000):
            cost = self.batch(count, 2, self.loads)
            rows.append((count, cost.wall, cost.cpu, 1000 * cost.cpu / count, 1000 * (cost.cpu - cost.of_jobs) / count))
        table("files of loads of 2 s, two processes, by jobs:",
              ("jobs", "wall, s", "CPU, s", "CPU, ms/job", "of it outside the jobs, ms/job"), rows)
        self.series["jobs"] = ("jobs", [(row[0], {"CPU, ms/job": row[3]}) for row in rows])

    def minutes(self):
        rows = []
        for minutes in (1, 5, 20, 60):
            source = ["demo:walk", "--seconds", str(60 * minutes)]
            clip = Cost([self.kinescope, "render", *source, "--size", "320x180", "--fps", "10", "--supersample", "1", "--force",
                         "--out", "a.mp4"], self.folder)
            loads = Cost([self.kinescope, "loads", *source, "--csv", "a.csv", "--json", "a.json"], self.folder)
            rows.append((minutes, clip.wall, clip.cpu / minutes, clip.megabytes, loads.wall, loads.cpu / minutes, loads.megabytes))
        table("clips (320x180, 10/s) and files of loads, by length:",
              ("minutes", "clip: wall, s", "CPU, s/min", "MB", "loads: wall, s", "CPU, s/min", "MB"), rows)
        self.series["minutes"] = ("minutes", [(row[0], {"clip, CPU s/min": row[2], "loads, CPU s/min": row[5]}) for row in rows])

    def live(self, people, viewers):
        """Server's CPU in percent of a core, its memory, and what page_viewers prints."""
        with socket.socket(type=socket.SOCK_DGRAM) as udp, socket.socket() as tcp:
            udp.bind(("127.0.0.1", 0))
            tcp.bind(("127.0.0.1", 0))
            udp_port, http_port = udp.getsockname()[1], tcp.getsockname()[1]
        server = subprocess.Popen([self.kinescope, "serve", "--source", f"udp://127.0.0.1:{udp_port}", "--http_port", str(http_port),
                                   "--ros", "off", "--pictures", "off"], cwd=self.folder, stderr=subprocess.PIPE, text=True)
        suits = None
        try:
            while "page at" not in server.stderr.readline():
                if server.poll() is not None:
                    sys.exit("the server did not start")
            suits = subprocess.Popen([self.kinescope, "stream", "demo:walk", "--characters", str(people), "--rate_hz", "60", "--to",
                                      f"udp://127.0.0.1:{udp_port}"], cwd=self.folder, stderr=subprocess.DEVNULL)
            watch = [self.viewers_program, str(http_port), str(viewers)]
            subprocess.run([*watch, "3"], check=True, stdout=subprocess.DEVNULL)  # until bodies are made
            ticks = self.ticks_of(server.pid)
            seen = subprocess.run([*watch, "10"], check=True, stdout=subprocess.PIPE, text=True).stdout
            percent = (self.ticks_of(server.pid) - ticks) / TICKS / 10 * 100
            memory = pathlib.Path(f"/proc/{server.pid}/status").read_text()
            return percent, int(re.search(r"VmRSS:\s+(\d+)", memory)[1]) / 1024, seen
        finally:
            for process in filter(None, (suits, server)):
                process.terminate()
                process.wait()

    @staticmethod
    def ticks_of(pid):
        fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
        return int(fields[11]) + int(fields[12])

    @staticmethod
    def p95_of(seen):
        return float(re.search(r"p95 ([\d.]+)", seen)[1])

    def people(self):
        rows = [(people, *self.live(people, 1)) for people in (1, 2, 4, 8, 16)]
        table("server of the page, 60 Hz, one viewer, no pictures, by people:", ("people", "CPU, % of a core", "MB", "latency p95, ms"),
              [(people, percent, memory, self.p95_of(seen)) for people, percent, memory, seen in rows])
        self.series["people"] = ("people", [(row[0], {"server, % of a core": row[1]}) for row in rows])

    def viewers(self):
        rows = [(viewers, *self.live(1, viewers)) for viewers in (1, 4, 16, 64)]
        table("server of the page, 60 Hz, one person, no pictures, by viewers:", ("viewers", "CPU, % of a core", "MB", "latency p95, ms"),
              [(viewers, percent, memory, self.p95_of(seen)) for viewers, percent, memory, seen in rows])
        self.series["viewers"] = ("viewers", [(row[0], {"server, % of a core": row[1]}) for row in rows])

    def draw(self, path):
        """A panel for each part, both axes logarithmic: a straight line of slope one is growth in proportion."""
        commands = [f"set terminal svg size {300 * len(self.series)},280 font 'DejaVu Sans,12' background '#ffffff'",
                    f"set output '{path}'", f"set multiplot layout 1,{len(self.series)}", "set logscale xy 2", "set grid lc '#d9dee5'",
                    "set key top left reverse Left samplen 1", "set offsets graph 0.05, graph 0.05, graph 0.4, graph 0.1"]
        for axis, points in self.series.values():
            lines = list(points[0][1])
            for i, line in enumerate(lines):
                commands += [f"$data{i} << END", *(f"{x} {ys[line]}" for x, ys in points), "END"]
            ticks = ", ".join(str(x) for x, _ in points)
            commands += [f"set xlabel '{axis}'", f"set xtics ({ticks})", "plot " + ", ".join(
                f"$data{i} using 1:2 with linespoints lw 2 pt 7 ps 0.6 lc '{color}' title '{line}'"
                for i, (line, color) in enumerate(zip(lines, ("#1d6fc0", "#b0241c"))))]
        subprocess.run(["gnuplot"], input="\n".join(commands) + "\n", text=True, check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--figure", type=pathlib.Path)
    parser.add_argument("--only", choices=("processes", "jobs", "minutes", "people", "viewers"))
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        growth = Growth(options.build.resolve(), pathlib.Path(folder))
        print(f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")
        for part in [options.only] if options.only else ["processes", "jobs", "minutes", "people", "viewers"]:
            getattr(growth, part)()
        if options.figure:
            growth.draw(options.figure.resolve())


if __name__ == "__main__":
    main()
