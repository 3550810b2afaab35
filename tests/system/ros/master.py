#!/usr/bin/env python3
"""The master of `roscore`, without rosout and its log, which says when it listens: a test need not ask.

usage: master.py PORT
"""
import signal
import sys

import rosmaster.master

master = rosmaster.master.Master(int(sys.argv[1]))
master.start()
print("listening", flush=True)
while True:
    signal.pause()
