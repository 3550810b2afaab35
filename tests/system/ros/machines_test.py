#!/usr/bin/python3
"""Two suits on two machines, the ROS master on a third one, monitor and page on a fourth one, with a network between them
that delays and loses packets, a clock that is 3 s behind, one that is set, and a master that moves. Usage: machines_test.py PROGRAM SETUP WRONG_CLOCK

PROGRAM: the built kinescope. SETUP: setup.sh of the devel space. WRONG_CLOCK: the library that sets a program's clock wrong.
Exit code 77: network namespaces or TUN devices are not possible here.
"""
import json
import os
import struct
import sys
import tempfile
import time
import urllib.request

import machines

PROGRAM, SETUP, WRONG_CLOCK = sys.argv[1:4]
DELAY, JITTER, LOSS = 0.05, 0.02, 0.02  # s, s, share
BEHIND = 3.0                             # s
SET_BACK = 5.0                           # s
PATIENCE = 60                            # s; only a failure takes so long
PAGE, LATE = (f'http://127.0.0.1:{port}/api/v1/' for port in (8080, 8081))


def get(what, page=PAGE):
    with urllib.request.urlopen(page + what, timeout=10) as answer:
        return json.load(answer)


def wait_for(what, condition):
    """The first truth of `condition`, which asks the page."""
    deadline, last = time.monotonic() + PATIENCE, None
    while time.monotonic() < deadline:
        try:
            last = condition()
            if last:
                return last
        except OSError as error:  # no page yet
            last = error
        time.sleep(0.05)  # between questions
    sys.exit(f'FAILED: {what} never happens; last: {last}\n' + logs())


def check(what, condition, seen):
    print('ok    ' if condition else 'FAILED', what)
    if not condition:
        sys.exit(f'{seen}\n' + logs())


def logs():
    return ''.join(f'--- {name}\n{open(os.path.join(FOLDER, name), encoding="utf-8").read()}'
                   for name in sorted(os.listdir(FOLDER)) if name.endswith('.log'))


def start(machine, name, command, **environment):
    with open(os.path.join(FOLDER, name + '.log'), 'w', encoding='utf-8') as log:
        children.append(machine.start(
            ['/bin/bash', '-c', f'. {SETUP} && exec {command}'],
            {'ROS_MASTER_URI': f'http://{"master" if hosts else master.address}:11311', 'ROS_IP': machine.address, 'ROS_HOME': FOLDER,
             'XDG_CACHE_HOME': FOLDER, 'XDG_STATE_HOME': FOLDER, 'PATH': '/usr/bin:' + os.environ['PATH'], **environment},
            stdout=log, stderr=log))


def start_everything():
    if hosts:
        hosts.set('master', master.address)
    start(master, 'master', 'roscore')
    start(suit_a, 'bridge_a', 'roslaunch --wait kinescope bridge.launch node:=bridge_a model_name:=anna source:=udp://:9763')
    start(suit_b, 'bridge_b', 'roslaunch --wait kinescope bridge.launch node:=bridge_b model_name:=ben source:=udp://:9763 '
          "options:='--ros required'", **wrong_clock('clock_b', -BEHIND))
    start(page, 'monitor', 'roslaunch --wait kinescope monitor.launch pictures:=off', **wrong_clock('clock_page', 0))
    start(suit_a, 'suit_a', f'{PROGRAM} stream demo:lift --to udp://127.0.0.1:9763')
    start(suit_b, 'suit_b', f'{PROGRAM} stream demo:walk --to udp://127.0.0.1:9763')


def set_clock(name, secs):
    """How much a computer's clock is ahead."""
    with open(os.path.join(FOLDER, name), 'r+b') as file:
        file.write(struct.pack('=q', int(1e9 * secs)))


def wrong_clock(name, secs):
    """The environment of programs with such a clock."""
    path = os.path.join(FOLDER, name)
    open(path, 'wb').close()
    set_clock(name, secs)
    return {'LD_PRELOAD': WRONG_CLOCK, 'WRONG_CLOCK': path}


def names(state):
    return sorted(person['name'] for person in state['people'])


def clocks():
    return {clock['node']: clock for clock in (get('diagnostics')['stream'] or {'clocks': []})['clocks']}


def check_people():
    wait_for('both people', lambda: names(get('state')) == ['anna', 'ben'])
    first, seen = get('state')['state_number'], []
    while len(seen) < 50:
        seen.append(wait_for('a new state', lambda: (state := get('state'))['state_number'] > first and state))
        first = seen[-1]['state_number']
    both = sum(names(state) == ['anna', 'ben'] for state in seen)
    check('both people are in the same states', both >= 45, f'{both} of {len(seen)}')
    for person in seen[-1]['people']:
        known = [load for load in person['loads'] if load['ratio'] is not None]
        check(f'{person["name"]} has loads and a centre of mass', len(known) >= 8 and person['com'], person)


def check_clocks():
    """What a round trip tells is exact within its uncertainty, however busy this computer is."""
    known = wait_for('the clocks', lambda: (all_ := clocks()) and len(all_) == 2 and
                     all(clock['offset_ms'] is not None for clock in all_.values()) and all_)
    for node, ahead in (('/bridge_a', 0), ('/bridge_b', -1000 * BEHIND)):
        clock = known[node]
        uncertainty = clock['uncertainty_ms'] + 0.2  # of rounding
        check(f'the clock of {node} is {clock["offset_ms"]} ± {clock["uncertainty_ms"]} ms ahead, its delay '
              f'{clock["delay_ms"]} to {clock["most_delay_ms"]} ms', abs(clock['offset_ms'] - ahead) <= uncertainty, clock)
        check('the delay is that of the network or longer', clock['delay_ms'] >= 1000 * DELAY - uncertainty, clock)
        check('a warning only of the wrong clock', ('behind the server' in clock['warning']) == (ahead != 0), clock)
    wait_for('corrected stamps', lambda: all(abs(clock['shift_ms'] + clock['offset_ms']) <= 200 for clock in clocks().values()))
    print('ok     the stamps are of one clock')


def check_cut():
    network.cut(suit_b)
    wait_for('the page without the person who is cut off', lambda: names(get('state')) == ['anna'])
    network.mend(suit_b)
    wait_for('both people again', lambda: names(get('state')) == ['anna', 'ben'])
    print('ok     a person who is cut off goes and comes back')


def check_set():
    """The clock of the page's machine is set back: both people go on at once, with stamps of its new time."""
    set_clock('clock_page', -SET_BACK)
    wait_for('the clock that was set', lambda: get('diagnostics')['stream']['clock_steps']['count'] == 1)
    wait_for('stamps of the new time', lambda: abs(get('state')['stamp_nanos'] * 1e-9 - (time.time() - SET_BACK)) < 1)
    for clock in clocks().values():
        check(f'the stamps of {clock["node"]} advance as fast as time', clock['excess_ms'] == 0, clock)
    check_people()


def check_moved():
    """The master moves to another computer, which has its name from then on."""
    if not hosts:
        print('skipped: a master that moves needs mounts (unshare -rnm)')
        return
    network.cut(master)
    hosts.set('master', new_master.address)
    start(new_master, 'new_master', 'roscore')
    start(page, 'late', f'{PROGRAM} serve ros: __name:=late --http_port 8081 --pictures off')
    wait_for('both people for who comes after the move', lambda: names(get('state', LATE)) == ['anna', 'ben'])
    wait_for('both people for who was there', lambda: names(get('state')) == ['anna', 'ben'])
    print('ok     a master that moves is found where it is')


machines.enter_own_network()
network = machines.Network(DELAY, JITTER, LOSS, seed=1)
suit_a, suit_b, page, master, new_master = (network.add(f'10.77.0.{i}') for i in (1, 2, 3, 4, 5))
children = []
with tempfile.TemporaryDirectory() as FOLDER:
    hosts = machines.Names(os.path.join(FOLDER, 'hosts')) if machines.Names.are_possible() else None
    network.start()
    page.enter()
    try:
        start_everything()
        check_people()
        check_clocks()
        check_cut()
        check_set()
        check_moved()
        print(f'{network.passed} packets passed, {network.lost} lost')
    finally:
        killed = machines.stop(children)
        network.stop()
    check('all programs end when they are told to', killed == 0, f'{killed} were killed')
