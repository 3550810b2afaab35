#!/usr/bin/env python3
"""Writes an MVNX recording with one posture per sample, of the person of another recording.

    kinescope convert demo:t_pose --seconds 0.01 --out t_pose.mvnx
    docs/postures.py t_pose.mvnx postures.mvnx      # prints the name of each sample

The first sample of the other recording must be a T-pose. Angles are those of Kinescope's joints (docs/urdf.md), degrees:
about y, then x, then z of the link; x, y, z below are those of the left side.
"""
import math
import re
import sys

SEGMENTS = ["pelvis", "l5", "l3", "t12", "t8", "neck", "head",
            "right_shoulder", "right_upper_arm", "right_forearm", "right_hand",
            "left_shoulder", "left_upper_arm", "left_forearm", "left_hand",
            "right_upper_leg", "right_lower_leg", "right_foot", "right_toe",
            "left_upper_leg", "left_lower_leg", "left_foot", "left_toe"]
PARENTS = [-1, 0, 1, 2, 3, 4, 5, 4, 7, 8, 9, 4, 11, 12, 13, 0, 15, 16, 17, 0, 19, 20, 21]
# How far the skin is below the origin of a segment that lies on the floor, m.
RADII = {"pelvis": 0.115, "t8": 0.12, "head": 0.07, "upper_arm": 0.05, "forearm": 0.045, "hand": 0.02, "upper_leg": 0.10,
         "lower_leg": 0.06, "foot": 0.08, "toe": 0.018}

SPINE = ["l5", "l3", "t12", "t8"]
# name: (pitch of the pelvis, {segment or part of both sides: (x, y, z)}).
POSTURES = {
    "n_pose": (0, {}),
    "t_pose": (0, {"upper_arm": (90, 0, 0)}),
    "arms_overhead": (0, {"shoulder": (22, 0, 0), "upper_arm": (143, 0, 0)}),
    "elbow_150": (0, {"upper_arm": (12, -20, 0), "forearm": (0, -150, 0)}),
    "knee_150": (0, {"upper_arm": (14, 0, 0), "right_upper_leg": (0, -30, 0), "right_lower_leg": (0, 150, 0)}),
    "hip_120": (0, {"upper_arm": (14, 0, 0), "right_upper_leg": (0, -120, 0), "right_lower_leg": (0, 100, 0)}),
    "bent_and_twisted": (15, {**{segment: (4, 14, 11) for segment in SPINE}, "upper_arm": (14, -55, 0),
                              "upper_leg": (4, -15, 0)}),
    "kneel": (0, {"right_upper_leg": (0, 0, 0), "right_lower_leg": (0, 95, 0), "right_foot": (0, 30, 0),
                  "left_upper_leg": (4, -92, 0), "left_lower_leg": (0, 92, 0), "upper_arm": (10, -30, 0),
                  "forearm": (0, -60, 0)}),
    "crawl": (85, {"upper_leg": (4, -85, 0), "lower_leg": (0, 92, 0), "foot": (0, 45, 0), "upper_arm": (4, -80, 0),
                   "hand": (75, 0, 0), "neck": (0, -20, 0), "head": (0, -20, 0)}),
    "lie": (-90, {"upper_arm": (22, 0, 0), "upper_leg": (6, 0, 0), "foot": (0, 20, 0)}),
    "sit": (0, {"upper_leg": (6, -90, 0), "lower_leg": (0, 90, 0), "upper_arm": (8, -35, 0), "forearm": (0, -55, 0)}),
    "squat": (25, {**{segment: (0, 5, 0) for segment in SPINE}, "upper_leg": (14, -118, 0), "lower_leg": (0, 128, 0),
                   "foot": (0, -35, 0), "upper_arm": (6, -75, 0), "head": (0, -20, 0)}),
    "lift": (40, {**{segment: (0, 7, 0) for segment in SPINE}, "upper_leg": (6, -85, 0), "lower_leg": (0, 75, 0),
                  "foot": (0, -30, 0), "upper_arm": (4, -65, 0), "forearm": (0, -12, 0), "neck": (0, -10, 0)}),
    "walk": (0, {"right_upper_leg": (0, -26, 0), "right_lower_leg": (0, 8, 0), "right_foot": (0, 5, 0),
                 "left_upper_leg": (0, 16, 0), "left_lower_leg": (0, 30, 0), "left_foot": (0, 8, 0), "left_toe": (0, -32, 0),
                 "right_upper_arm": (-6, 18, 0), "left_upper_arm": (6, -22, 0), "forearm": (0, -22, 0)}),
}


def product(a, b):
    return (a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
            a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0])


def rotated(q, vector):
    return product(product(q, (0, *vector)), (q[0], -q[1], -q[2], -q[3]))[1:]


def turn(axis, degrees):
    half = math.radians(degrees) / 2
    return (math.cos(half), *(math.sin(half) * (axis == i) for i in range(3)))


def link_of(segment):
    """The rotation of the link in the segment's frame: arms hang in the link's."""
    is_arm = segment.endswith(("arm", "hand"))
    return turn(0, (-90 if segment.startswith("right") else 90) if is_arm else 0)


def of_side(segment, angles):
    """The angles of this segment, of those that have its name or that of its part on both sides."""
    side, _, part = segment.partition("_")
    if part not in angles or side not in ("left", "right"):
        return angles.get(segment, (0, 0, 0))
    x, y, z = angles[part]
    return (-x, y, -z) if side == "right" and segment not in angles else angles.get(segment, (x, y, z))


def posed(origins, pitch, angles):
    """Positions and orientations of all segments, standing or lying on the floor."""
    positions, orientations = [], []
    for i, segment in enumerate(SEGMENTS):
        if i == 0:
            positions.append((0, 0, 0))
            orientations.append(turn(1, pitch))
            continue
        parent = SEGMENTS[PARENTS[i]]
        x, y, z = of_side(segment, angles)
        joint = product(product(turn(1, y), turn(0, x)), turn(2, z))
        back = link_of(segment)
        parent_from_segment = product(product(link_of(parent), joint), (back[0], -back[1], -back[2], -back[3]))
        orientations.append(product(orientations[PARENTS[i]], parent_from_segment))
        offset = [a - b for a, b in zip(origins[i], origins[PARENTS[i]])]
        move = rotated(orientations[PARENTS[i]], offset)
        positions.append(tuple(a + b for a, b in zip(positions[PARENTS[i]], move)))
    floor = min(p[2] - RADII.get(s.removeprefix("right_").removeprefix("left_"), 0) for p, s in zip(positions, SEGMENTS))
    return [(x, y, z - floor) for x, y, z in positions], orientations


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        text = file.read()
    head = text[:re.search(r'\s*<frame [^>]*type="normal"', text).start()]
    values = [float(v) for v in re.search(r'type="tpose">.*?<position>(.*?)</position>', text, re.S)[1].split()]
    origins = [values[3 * i:3 * i + 3] for i in range(len(SEGMENTS))]
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write(head)
        for index, (name, (pitch, angles)) in enumerate(POSTURES.items()):
            numbers = [" ".join(f"{v:.6f}" for item in items for v in item)
                       for items in reversed(posed(origins, pitch, angles))]
            file.write(f'\n<frame time="{round(index * 1000 / 120)}" index="{index}" type="normal">'
                       f"<orientation>{numbers[0]}</orientation><position>{numbers[1]}</position></frame>")
            print(name)
        file.write("\n</frames></subject></mvnx>\n")


main()
