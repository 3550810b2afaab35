#!/usr/bin/env python3
"""Holds the last sample of an MVNX recording for a second, so that programs that show a stream can show this moment.

    kinescope convert demo:lift --seconds 1.2 --out motion.mvnx
    docs/hold.py motion.mvnx moment.mvnx    # prints x and y of the pelvis, m, and the heading of the person, degrees
"""
import math
import re
import sys

SAMPLES, RATE_HZ = 120, 120


def values(frame, quantity):
    return re.search(rf"<{quantity}>(.*?)</{quantity}>", frame, re.S)[1].split()


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        text = file.read()
    frames = list(re.finditer(r'<frame [^>]*type="normal">.*?</frame>', text, re.S))
    orientation, position = (values(frames[-1][0], quantity) for quantity in ("orientation", "position"))
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write(text[:frames[0].start()])
        for index in range(SAMPLES):
            file.write(f'<frame time="{round(index * 1000 / RATE_HZ)}" index="{index}" type="normal">'
                       f'<orientation>{" ".join(orientation)}</orientation><position>{" ".join(position)}</position></frame>\n')
        file.write(text[frames[-1].end():])
    w, x, y, z = map(float, orientation[:4])
    print(*position[:2], math.degrees(math.atan2(2 * (x * y + w * z), 1 - 2 * (y * y + z * z))))


main()
