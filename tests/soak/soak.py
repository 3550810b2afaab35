#!/usr/bin/env python3
"""Attacks a running Kinescope with everything at once and writes down what it does, minute by minute.

BUILD: a build folder, such as build/dev. One honest person at 240 Hz beside hostile datagrams of every kind (5,000/s), people
who come and go, a second suit that starts every minute, slow and greedy HTTP clients of another address, a viewer of the page with pictures, a ROS subscriber, and a
recorder with its own suit and 500 hostile datagrams/s. Exit code 1 if a sample of the honest people was lost, a process ended, or the
page was older than 0.1 s (95th percentile) in a minute."""
import argparse
import concurrent.futures
import http.client
import json
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request

RATE_HZ = 240
WATCHED_SECS = 45  # of each minute
STRANGER = ('127.0.0.2', 0)  # another address than that of the honest viewer


def free_port(kind=socket.SOCK_STREAM):
    with socket.socket(socket.AF_INET, kind) as probe:
        probe.bind(('127.0.0.1', 0))
        return probe.getsockname()[1]


class Greedy(threading.Thread):
    """HTTP clients that want too much: connections that never finish a request, and the largest pictures."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.port = port
        self.stopping = threading.Event()

    def run(self):
        slow = []
        while not self.stopping.wait(0.5):
            try:
                while len(slow) < 300:
                    client = socket.create_connection(('127.0.0.1', self.port), timeout=2, source_address=STRANGER)
                    client.sendall(b'GET / HTTP/1.1\r\nHost: ')
                    slow.append(client)
            except OSError:
                for client in slow:
                    client.close()
                slow = []
            threading.Thread(target=self.snapshot, daemon=True).start()

    def snapshot(self):
        try:
            client = http.client.HTTPConnection('127.0.0.1', self.port, timeout=10, source_address=STRANGER)
            client.request('GET', '/api/v1/snapshot.png?width=4096&height=4096')
            client.getresponse().read()
        except (OSError, http.client.HTTPException):
            pass


def status(pid):
    """Resident memory in MB and CPU time in s."""
    lines = pathlib.Path(f'/proc/{pid}/status').read_text().splitlines()
    memory = next(int(line.split()[1]) / 1024 for line in lines if line.startswith('VmRSS'))
    fields = pathlib.Path(f'/proc/{pid}/stat').read_text().rsplit(')', 1)[1].split()
    return memory, (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')


def wait_for(log, text, process):
    while text not in log.read_text():
        if process.poll() is not None:
            sys.exit(f'ended early:\n{log.read_text()}')
        time.sleep(0.1)


def wait_for_port(port):
    while True:
        try:
            return socket.create_connection(('127.0.0.1', port), timeout=1).close()
        except OSError:
            time.sleep(0.1)


class Soak:
    def __init__(self, build, folder):
        self.bin = build / 'bin/kinescope'
        self.build = build
        self.folder = folder
        self.processes = {}
        self.udp, self.record_udp, self.http = free_port(socket.SOCK_DGRAM), free_port(socket.SOCK_DGRAM), free_port()
        self.environment = dict(os.environ, ROS_MASTER_URI=f'http://127.0.0.1:{free_port()}', ROS_IP='127.0.0.1',
                                ROS_HOME=str(folder / 'ros'), XDG_CACHE_HOME=str(folder / 'cache'))

    def start(self, name, *command):
        log = self.folder / f'{name}.log'
        with log.open('w') as out:
            self.processes[name] = subprocess.Popen([str(part) for part in command], stdout=out, stderr=out,
                                                    env=self.environment)
        return log

    def kinescope(self, name, *arguments):
        return self.start(name, self.bin, *arguments)

    def begin(self):
        master = self.environment['ROS_MASTER_URI'].rsplit(':', 1)[1]
        rosmaster = subprocess.run(['which', 'rosmaster'], capture_output=True, text=True, check=True).stdout.strip()
        self.start('master', '/usr/bin/python3', rosmaster, '--core', '-p', master)
        wait_for_port(int(master))
        log = self.kinescope('serve', 'serve', '--source', f'udp://127.0.0.1:{self.udp}', '--http_port', self.http,
                             '--ros', 'required')
        wait_for(log, 'page at', self.processes['serve'])
        log = self.kinescope('record', 'record', f'udp://127.0.0.1:{self.record_udp}', '--out', self.folder / 'take.pcap',
                             '--seconds', 10 ** 6)
        wait_for(log, 'recording', self.processes['record'])
        for name, port in (('suit', self.udp), ('recorded_suit', self.record_udp)):
            self.kinescope(name, 'stream', 'demo:walk', '--rate_hz', RATE_HZ, '--to', f'udp://127.0.0.1:{port}', '--json')
        wait_for(self.folder / 'serve.log', 'live: ', self.processes['serve'])
        hostile = self.build / 'tests/soak/hostile_senders'
        self.start('hostile', hostile, self.udp, 'all', 5000, 10 ** 6)
        self.start('hostile_record', hostile, self.record_udp, 'all', 500, 10 ** 6)
        self.start('visitors', hostile, self.udp, 'visitors', 480, 10 ** 6)
        self.greedy = Greedy(self.http)
        self.greedy.start()

    def diagnostics(self):
        with urllib.request.urlopen(f'http://127.0.0.1:{self.http}/api/v1/diagnostics', timeout=30) as answer:
            return json.load(answer)

    def watch(self):
        """What a viewer of the page and a ROS subscriber got: {'states': (rate, p95 ms), 'pictures': ..., 'lost': samples}."""
        count = RATE_HZ * WATCHED_SECS
        listener = subprocess.Popen([self.build / 'tests/bench/ros_latency', str(count), str(RATE_HZ), '/kinescope/joint_states'],
                                    env=self.environment, stdout=subprocess.PIPE, text=True)
        out = subprocess.run([self.build / 'tests/bench/page_viewers', str(self.http), '1', str(WATCHED_SECS), 'pictures'],
                             capture_output=True, text=True, check=False).stdout
        figures = {}
        for line in out.splitlines():
            what, rest = line.split(':', 1)
            figures[what] = (float(rest.split()[0]), float(rest.split('p95 ')[1].split(',')[0]))
        heard = listener.communicate(timeout=60)[0]
        came, sent = heard.split(' samples')[0].split(' of ')
        figures['lost'] = int(sent) - int(came)
        return figures

    def second_suit(self):
        """A suit that starts now, for 20 s: the share of the last 15 s in which the page has it beside the first one."""
        suit = subprocess.Popen([str(self.bin), 'stream', 'demo:squat', '--rate_hz', str(RATE_HZ), '--seconds', '20', '--to',
                                 f'udp://127.0.0.1:{self.udp}'], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(4)
        there, asked = 0, 0
        while suit.poll() is None:
            with urllib.request.urlopen(f'http://127.0.0.1:{self.http}/api/v1/state', timeout=30) as answer:
                names = [person.get('name') for person in json.load(answer)['people']]
            asked += 1
            there += names.count('Demo') >= 2
            time.sleep(0.5)
        return there / max(asked, 1)

    def dead(self):
        return [name for name, process in self.processes.items() if process.poll() is not None]

    def end(self):
        """Lines about the recording."""
        self.greedy.stopping.set()
        self.processes['recorded_suit'].send_signal(signal.SIGINT)
        self.processes['recorded_suit'].wait(60)
        for name in ('record', 'serve'):
            self.processes[name].send_signal(signal.SIGINT)
            self.processes[name].wait(120)
        for process in self.processes.values():
            process.kill()
        said = (self.folder / 'recorded_suit.log').read_text()
        sent = json.loads(said[said.index('{'):said.rindex('}') + 1])
        return [f'Recorder: {(self.folder / "record.log").read_text().strip().splitlines()[-1]}',
                f'Suit beside it: {sent.get("datagrams", "?")} datagrams sent.']


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('build', type=pathlib.Path)
    parser.add_argument('minutes', type=int)
    parser.add_argument('--out', type=pathlib.Path, default=pathlib.Path('soak.md'))
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        soak = Soak(options.build.resolve(), pathlib.Path(folder))
        soak.begin()
        rows, faults = [], []
        before = soak.diagnostics()['source']
        cpu_before = status(soak.processes['serve'].pid)[1]
        for minute in range(1, options.minutes + 1):
            began = time.monotonic()
            with concurrent.futures.ThreadPoolExecutor() as aside:
                second = aside.submit(soak.second_suit)
                seen = soak.watch()
            seen['second suit'] = 100 * second.result()
            time.sleep(max(0, 60 - (time.monotonic() - began)))
            memory, cpu = status(soak.processes['serve'].pid)
            source = soak.diagnostics()['source']
            states, pictures = seen.get('states', (0, 1e9)), seen.get('pictures', (0, 1e9))
            rows.append((minute, memory, status(soak.processes['record'].pid)[0], (cpu - cpu_before) / 60 * 100,
                         source['datagrams'] - before['datagrams'], source['samples'] - before['samples'],
                         source['transport'].get('kernel_drops', 0), seen['lost'], seen['second suit'], *states, *pictures))
            before, cpu_before = source, cpu
            faults += [f'minute {minute}: {name} ended' for name in soak.dead()]
            if seen['lost'] > 0:
                faults.append(f'minute {minute}: {seen["lost"]} samples did not reach ROS')
            if seen['second suit'] < 90:
                faults.append(f'minute {minute}: the second suit was there in {seen["second suit"]:.0f} % of its time')
            if states[1] > 100:
                faults.append(f'minute {minute}: the page was {states[1]} ms old')
            print('| ' + ' | '.join(f'{value:.0f}' for value in rows[-1]) + ' |', flush=True)
            if soak.dead():
                break
        end = soak.end()
        text = ['| minute | serve MB | record MB | serve CPU % | datagrams | samples | kernel drops | lost to ROS | second suit % | states/s | p95 ms | '
                'pictures/s | p95 ms |', '|' + '---|' * 13]
        text += ['| ' + ' | '.join(f'{value:.0f}' for value in row) + ' |' for row in rows]
        text += [''] + (faults or ['No process ended, no sample was lost, no page was late.']) + end
        options.out.write_text('\n'.join(text) + '\n')
        return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())
