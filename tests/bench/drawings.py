#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""Draws the pictures of docs/tools.md.

    drawings.py draw FOLDER     FOLDER/*.svg anew
    drawings.py check FOLDER    whether they are what would be drawn

Needs python3-matplotlib; the same version gives the same bytes.
Exit codes: 0 done, 1 a picture is another, 2 failed, 3 usage, 77 the matplotlib of plots.DRAWN_BY is
not here to check with.
"""

import math
import sys

import plots

try:
    from matplotlib import patches, pyplot
except ImportError:
    pyplot = None

CORE, ROUND, SURFACE, HAND, FORCE = "#0072b2", "#cfe6f5", "#d9d2c5", "#888888", "#d55e00"


def panels(titles, height):
    """Axes without ticks and with equal scales."""
    figure, axes = pyplot.subplots(1, len(titles), figsize=(9.6, height))
    figure.subplots_adjust(left=0.01, right=0.99, top=1 - 0.3 / height, bottom=0.02, wspace=0.04)
    for one, title in zip(axes, titles):
        one.set_title(title)
        one.set_aspect("equal")
        one.axis("off")
    return figure, axes


def solid(corners, colour=CORE):
    return patches.Polygon(corners, closed=True, color=colour, linewidth=0.8)


def grown(axes, corners, radius):
    """Points within the radius of a polygon: the polygon, a strip for each edge, a disc for each
    corner; drawn in one colour, so that no seam is visible."""
    axes.add_patch(patches.Polygon(corners, closed=True, color=ROUND, linewidth=0))
    for (x, y), (u, v) in zip(corners, corners[1:] + corners[:1]):
        axes.add_patch(patches.Circle((x, y), radius, color=ROUND, linewidth=0))
        length = math.hypot(u - x, v - y)
        if length > 0:
            a, b = -radius * (v - y) / length, radius * (u - x) / length
            axes.add_patch(patches.Polygon([(x + a, y + b), (u + a, v + b), (u - a, v - b),
                                            (x - a, y - b)], closed=True, color=ROUND, linewidth=0))
    axes.add_patch(solid(corners))


def measure(axes, start, end, name, offset=(0, 0)):
    """Length with its name."""
    axes.annotate("", start, end, arrowprops={"arrowstyle": "<->", "color": "#333333",
                                              "linewidth": 0.8, "shrinkA": 0, "shrinkB": 0})
    axes.text((start[0] + end[0]) / 2 + offset[0], (start[1] + end[1]) / 2 + offset[1], name,
              ha="center", va="center")


def arrow(axes, start, end, colour, name="", offset=(0, 0)):
    axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 1.6,
                                              "shrinkA": 0, "shrinkB": 0})
    axes.text(end[0] + offset[0], end[1] + offset[1], name, color=colour, ha="center", va="center")


def shapes(_):
    """Each form of --tool, cut through its middle: its core, and the radius around it."""
    figure, axes = panels(("point", "sphere:R", "capsule:R,L", "box:X,Y,Z,R", "hull:FILE,R",
                           "mesh:NAME,R"), 2.4)
    for one in axes:
        one.set(xlim=(-1.25, 1.25), ylim=(-1.45, 1.45))
    axes[0].plot(0, 0, "o", color=CORE, markersize=4)
    axes[1].add_patch(patches.Circle((0, 0), 0.7, color=ROUND, linewidth=0))
    axes[1].plot(0, 0, "o", color=CORE, markersize=4)
    measure(axes[1], (0, 0), (0.495, 0.495), "R", (0.12, -0.12))
    grown(axes[2], [(0, -0.7), (0, 0.7)], 0.4)
    measure(axes[2], (-0.6, -0.7), (-0.6, 0.7), "L", (-0.2, 0))
    measure(axes[2], (0, 0.7), (0.4, 0.7), "R", (0.05, -0.17))
    grown(axes[3], [(-0.6, -0.75), (0.6, -0.75), (0.6, 0.75), (-0.6, 0.75)], 0.2)
    measure(axes[3], (-0.6, 1.15), (0.6, 1.15), "X", (0, 0.18))
    measure(axes[3], (-1.0, -0.75), (-1.0, 0.75), "Z", (-0.17, 0))
    measure(axes[3], (0.6, -0.5), (0.8, -0.5), "R", (0.3, 0))
    hull = [(0, -0.95), (0.6, 0.1), (0.45, 0.8), (-0.5, 0.75), (-0.65, 0.0)]
    grown(axes[4], hull, 0.18)
    for x, y in hull:
        axes[4].plot(x, y, "o", color="#003a5d", markersize=3)
    ring = [(math.cos(0.3 + 5.6 * i / 14), math.sin(0.3 + 5.6 * i / 14)) for i in range(15)]
    hook = [(0.85 * x, 0.95 * y) for x, y in ring] + [(0.4 * x, 0.45 * y) for x, y in ring[::-1]]
    grown(axes[5], hook, 0.12)
    figure.text(0.5, 0.045, "dark: the core, which never crosses a surface; light: the radius R, "
                "which touches and slides. The tool's z points up.", ha="center")
    return figure


def spring(axes, start, end, turns=7, width=0.07):
    """Zigzag between two places."""
    along = (end[0] - start[0], end[1] - start[1])
    length = math.hypot(*along)
    across = (-along[1] / length * width, along[0] / length * width)
    places = [start]
    for i in range(2 * turns):
        share, side = (0.1 + 0.8 * (i + 0.5) / (2 * turns)), 1 if i % 2 else -1
        places.append((start[0] + share * along[0] + side * across[0],
                       start[1] + share * along[1] + side * across[1]))
    axes.plot(*zip(*places, end), color="#333333", linewidth=0.9)


def turned(corners, place, angle):
    c, s = math.cos(angle), math.sin(angle)
    return [(place[0] + c * x - s * y, place[1] + s * x + c * y) for x, y in corners]


def ground(axes, slope=0.0):
    rise = 1.5 * math.tan(slope)
    axes.add_patch(patches.Polygon([(-1.5, -rise), (1.5, rise), (1.5, -1.5), (-1.5, -1.5)],
                                   closed=True, color=SURFACE, linewidth=0))


def coupling(_):
    """Forces on a tool: two springs, friction's cone, and the springs of --fixture."""
    figure, axes = panels(("held back: two springs", "friction: it sticks", "friction: it slides",
                           "guided: plane, line, point"), 2.9)
    for one in axes:
        one.set(xlim=(-1.5, 1.5), ylim=(-1.45, 1.6))
    brick = [(-0.55, -0.3), (0.55, -0.3), (0.55, 0.3), (-0.55, 0.3)]
    ground(axes[0])
    hand = (0.1, -0.55)
    axes[0].add_patch(patches.Polygon(turned(brick, hand, 0.5), closed=True, fill=False,
                                      edgecolor=HAND, linestyle="--"))
    held = turned(brick, (-0.02, 0.36), 0.08)
    axes[0].add_patch(solid(held))
    spring(axes[0], hand, (-0.02, 0.36))
    arrow(axes[0], (-0.02, 0.36), (-0.1, 1.3), FORCE, "force", (0.42, 0.02))
    axes[0].add_patch(patches.Arc((-0.02, 0.36), 1.9, 1.9, theta1=12, theta2=48, color=FORCE,
                                  linewidth=1.4))
    arrow(axes[0], (0.905, 0.6), (0.91, 0.5), FORCE, "torque", (0.28, -0.06))
    axes[0].text(0.1, -1.18, "where the hand is", color=HAND, ha="center")
    for one, lean, name in ((axes[1], 0.2, "within the cone"), (axes[2], 0.62, "beyond it")):
        ground(one)
        one.add_patch(patches.Wedge((0, 0), 1.15, 90 - 22, 90 + 22, color="#f6d8c6", linewidth=0))
        one.add_patch(solid(turned([(-0.3, 0), (0.3, 0), (0.3, 0.4), (-0.3, 0.4)], (0, 0), 0)))
        tip = (-1.35 * math.sin(lean), 1.35 * math.cos(lean))
        one.plot((0, 0.75 * math.tan(lean)), (0, -0.75), color=HAND, linestyle="--", linewidth=1)
        one.plot(0.75 * math.tan(lean), -0.75, "o", color=HAND, markersize=5)
        one.text(0.75 * math.tan(lean), -0.98, "hand", color=HAND, ha="center")
        if lean < 0.3:
            arrow(one, (0, 0), tip, FORCE, "force", (0, 0.13))
            one.text(0.62, 1.12, "atan(static)", ha="left", color="#a0522d")
        else:
            edge = math.radians(22)
            arrow(one, (0, 0), (-1.3 * math.sin(edge), 1.3 * math.cos(edge)), FORCE, "force",
                  (0, 0.13))
            arrow(one, (0.34, 0.2), (0.95, 0.2), CORE, "goes", (0.02, 0.17))
            one.text(0.62, 1.12, "atan(dynamic)", ha="left", color="#a0522d")
        one.text(0, -1.35, f"what pulls at it is {name}", ha="center")
    plane, line, point = (-1.0, 0.0), (0.1, 0.0), (1.05, 0.0)
    free = axes[3]
    free.add_patch(patches.Polygon([(-1.45, -0.9), (-1.0, -0.9), (-1.0, 0.9), (-1.45, 0.9)],
                                   closed=True, color="#eeeeee", linewidth=0))
    free.plot((plane[0],) * 2, (-0.9, 0.9), color=CORE)
    arrow(free, (-1.0, 0.6), (-0.7, 0.6), CORE, "N", (0.1, 0.02))
    spring(free, (-1.4, -0.2), (-1.0, -0.2), 3)
    free.plot(-1.4, -0.2, "o", color=HAND, markersize=5)
    free.plot((line[0],) * 2, (-0.9, 0.9), color=CORE)
    arrow(free, (0.1, 0.6), (0.1, 0.85), CORE, "D", (0.15, 0.02))
    spring(free, (-0.35, -0.2), (0.1, -0.2), 3)
    free.plot(-0.35, -0.2, "o", color=HAND, markersize=5)
    free.plot(*point, "o", color=CORE, markersize=5)
    spring(free, (0.7, -0.55), point, 4)
    free.plot(0.7, -0.55, "o", color=HAND, markersize=5)
    free.text(0, -1.35, "each at most F strong, K stiff", ha="center")
    return figure


if __name__ == "__main__":
    sys.exit(plots.run(sys.argv[1:], __doc__, (shapes, coupling), lambda _: None))
