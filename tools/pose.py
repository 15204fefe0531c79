#!/usr/bin/env python3
"""Bends or twists the vertices of an OBJ file: a stand-in for the hand that would pose a cage.

  pose.py cage.obj posed.obj --bend 50     the upper part leans sideways by 50 degrees
  pose.py cage.obj posed.obj --twist 90    the top turns by 90 degrees about the up axis
"""

import argparse
import math


def smooth(t):
    """0 below 0, 1 above 1, and a smooth step between them."""
    t = min(1.0, max(0.0, t))
    return t * t * (3 - 2 * t)


def bent(point, low, high, radians):
    """The spine from low to high becomes an arc in the x-y plane; above it the rest goes straight."""
    x, y, z = point
    height = high - low
    s = min(max(y - low, 0.0), height)
    angle = radians * s / height
    radius = height / radians
    # The spine's point at arc length s, and the frame there: the point keeps its place in the frame.
    px = radius * (1 - math.cos(angle))
    py = low + radius * math.sin(angle)
    beyond = y - low - s
    return (px + x * math.cos(angle) + beyond * math.sin(angle),
            py - x * math.sin(angle) + beyond * math.cos(angle), z)


def twisted(point, low, high, radians):
    x, y, z = point
    angle = radians * smooth((y - low) / (high - low))
    return (x * math.cos(angle) + z * math.sin(angle), y, z * math.cos(angle) - x * math.sin(angle))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("input")
    parser.add_argument("output")
    parser.add_argument("--bend", type=float, default=0.0, help="degrees, to the side")
    parser.add_argument("--twist", type=float, default=0.0, help="degrees, about the up axis y")
    arguments = parser.parse_args()

    with open(arguments.input, encoding="utf-8") as file:
        lines = file.read().splitlines()
    points = [tuple(map(float, line.split()[1:4])) for line in lines if line.startswith("v ")]
    low = min(p[1] for p in points)
    top = max(p[1] for p in points)
    middle = [(min(p[a] for p in points) + max(p[a] for p in points)) / 2 for a in range(3)]
    # Feet stay on the ground, and the head stays a head: only the trunk gives way.
    begin, end = low + 0.25 * (top - low), low + 0.8 * (top - low)

    def pose(p):
        p = (p[0] - middle[0], p[1], p[2] - middle[2])
        if arguments.twist:
            p = twisted(p, begin, end, math.radians(arguments.twist))
        if arguments.bend:
            p = bent(p, begin, end, math.radians(arguments.bend))
        return (p[0] + middle[0], p[1], p[2] + middle[2])

    posed = iter([pose(p) for p in points])
    with open(arguments.output, "w", encoding="utf-8") as file:
        for line in lines:
            if line.startswith("v "):
                line = "v %.17g %.17g %.17g" % next(posed)
            file.write(line + "\n")


if __name__ == "__main__":
    main()
