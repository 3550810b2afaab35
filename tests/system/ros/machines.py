"""Machines in a network, on one computer and without root: network namespaces whose packets go through this process,
which delays and loses them. The kernel's netem would do that, where a kernel has it."""
import contextlib
import ctypes
import fcntl
import heapq
import os
import random
import selectors
import signal
import socket
import struct
import subprocess
import sys
import threading
import time

SKIPPED = 77  # exit code of a test that cannot run here
_TUNSETIFF, _IFF_TUN, _IFF_NO_PI = 0x400454CA, 0x0001, 0x1000
_CLONE_NEWNET = 0x40000000
_libc = ctypes.CDLL(None, use_errno=True)


def _call(name, *arguments):
    if getattr(_libc, name)(*arguments) != 0:
        error = ctypes.get_errno()
        raise OSError(error, f'{name}: {os.strerror(error)}')


def enter_own_network():
    """Starts the program again in a user namespace with a network of its own; ends it with SKIPPED where that is not possible."""
    if os.environ.get('MACHINES') == 'here':
        return
    for needed, why in ((os.access('/dev/net/tun', os.R_OK | os.W_OK), '/dev/net/tun, readable and writable'),
                        (subprocess.run(['unshare', '-rn', 'true'], check=False).returncode == 0,
                         'user namespaces with networks (unshare -rn)')):
        if not needed:
            print(f'skipped: needs {why}')
            sys.exit(SKIPPED)
    os.execvpe('unshare', ['unshare', '-rnm' if Names.are_possible() else '-rn', sys.executable, *sys.argv], {**os.environ, 'MACHINES': 'here'})


class Names:
    """The names of machines, as all programs here look them up."""

    @staticmethod
    def are_possible():
        """Asked outside and inside of the own network; some containers allow that, and no mounts."""
        own = [] if os.environ.get('MACHINES') == 'here' else ['unshare', '-rnm']
        return subprocess.run([*own, 'mount', '--bind', '/etc/hosts', '/etc/hosts'], check=False).returncode == 0

    def __init__(self, file):
        """file: replaces /etc/hosts for this process and those that it starts."""
        self._file, self._all = file, {'localhost': '127.0.0.1'}
        self._write()
        subprocess.run(['mount', '--bind', file, '/etc/hosts'], check=True)

    def set(self, name, address):
        self._all[name] = address
        self._write()

    def _write(self):
        with open(self._file, 'w', encoding='utf-8') as hosts:
            hosts.writelines(f'{address} {name}\n' for name, address in self._all.items())


class Network:
    """Every packet between two machines takes `delay` s, and up to `jitter` s more; the share `loss` is lost. Packets do not
    overtake each other."""

    def __init__(self, delay, jitter, loss, seed):
        self.delay, self.jitter, self.loss = delay, jitter, loss
        self._random = random.Random(seed)
        self._machines = {}   # by address
        self._cut = set()     # addresses
        self._waiting = []    # (due, number, to, packet)
        self._last_due = {}   # by (from, to)
        self._numbers = 0
        self._selector = selectors.DefaultSelector()
        self._wake_read, self._wake_write = os.pipe()
        self._selector.register(self._wake_read, selectors.EVENT_READ, None)
        self._stopping = False
        self._thread = threading.Thread(target=self._run, daemon=True)
        self.lost = self.passed = 0

    def add(self, address):
        """A new machine; only before start()."""
        _call('unshare', _CLONE_NEWNET)
        machine = Machine(self, address)
        self._machines[address] = machine
        self._selector.register(machine.tun, selectors.EVENT_READ, machine)
        return machine

    def start(self):
        self._thread.start()

    def stop(self):
        self._stopping = True
        os.write(self._wake_write, b'.')
        self._thread.join()

    def cut(self, machine):
        """Nothing goes to or from the machine until mend()."""
        self._cut.add(machine.address)

    def mend(self, machine):
        self._cut.discard(machine.address)

    def _run(self):
        while not self._stopping:
            now = time.monotonic()
            while self._waiting and self._waiting[0][0] <= now:
                _, _, to, packet = heapq.heappop(self._waiting)
                with contextlib.suppress(OSError):  # its queue is full: lost
                    os.write(to.tun, packet)
            wait = self._waiting[0][0] - now if self._waiting else None
            for key, _ in self._selector.select(wait):
                if key.data is not None:
                    self._take(key.data)

    def _take(self, machine):
        packet = os.read(machine.tun, 65536)
        if packet[0] >> 4 != 4:
            return
        to = self._machines.get(socket.inet_ntoa(packet[16:20]))
        if to is None:
            return
        if machine.address in self._cut or to.address in self._cut or self._random.random() < self.loss:
            self.lost += 1
            return
        way = (machine.address, to.address)
        due = max(time.monotonic() + self.delay + self._random.random() * self.jitter, self._last_due.get(way, 0))
        self._last_due[way] = due
        self._numbers += 1
        self.passed += 1
        heapq.heappush(self._waiting, (due, self._numbers, to, packet))


class Machine:
    """A network namespace with one address. Made by Network.add()."""

    def __init__(self, network, address):
        self.network, self.address = network, address
        self._namespace = os.open('/proc/thread-self/ns/net', os.O_RDONLY)
        self.tun = os.open('/dev/net/tun', os.O_RDWR | os.O_NONBLOCK)
        fcntl.ioctl(self.tun, _TUNSETIFF, struct.pack('16sH22x', b'net0', _IFF_TUN | _IFF_NO_PI))
        for command in (['link', 'set', 'lo', 'up'], ['addr', 'add', f'{address}/24', 'dev', 'net0'],
                        ['link', 'set', 'net0', 'up']):
            subprocess.run(['ip', *command], check=True)

    def enter(self):
        """The calling thread's sockets are of this machine from now on."""
        _call('setns', self._namespace, _CLONE_NEWNET)

    def start(self, command, environment, **options):
        enter = ['nsenter', f'--net=/proc/{os.getpid()}/fd/{self._namespace}', '--']  # this process has threads: no preexec_fn
        return subprocess.Popen([*enter, *command], env={**os.environ, **environment}, **options)


def stop(children):
    """Ends all of them; kills those that do not end within 30 s, and returns their number."""
    killed = 0
    for child in reversed(children):
        child.send_signal(signal.SIGTERM)
    for child in children:
        try:
            child.wait(30)
        except subprocess.TimeoutExpired:
            child.kill()
            child.wait()
            killed += 1
    return killed
