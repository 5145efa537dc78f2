#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""Draws the pictures of pages that need no results of a run.

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
    figure.text(0.5, 0.045, "dark: core, which never crosses a surface; light: radius R, which "
                "touches and slides. The z axis of the tool points up.", ha="center")
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
    """Forces on a tool: two springs, the friction cone, and the springs of --fixture."""
    figure, axes = panels(("contact: two springs", "friction: it sticks", "friction: it slides",
                           "fixture: plane, line, point"), 2.9)
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
    axes[0].text(0.1, -1.18, "device pose", color=HAND, ha="center")
    for one, lean, name in ((axes[1], 0.2, "within the cone"), (axes[2], 0.62, "outside the cone")):
        ground(one)
        one.add_patch(patches.Wedge((0, 0), 1.15, 90 - 22, 90 + 22, color="#f6d8c6", linewidth=0))
        one.add_patch(solid(turned([(-0.3, 0), (0.3, 0), (0.3, 0.4), (-0.3, 0.4)], (0, 0), 0)))
        tip = (-1.35 * math.sin(lean), 1.35 * math.cos(lean))
        one.plot((0, 0.75 * math.tan(lean)), (0, -0.75), color=HAND, linestyle="--", linewidth=1)
        one.plot(0.75 * math.tan(lean), -0.75, "o", color=HAND, markersize=5)
        one.text(0.75 * math.tan(lean), -0.98, "device", color=HAND, ha="center")
        if lean < 0.3:
            arrow(one, (0, 0), tip, FORCE, "force", (0, 0.13))
            one.text(0.62, 1.12, "atan(static)", ha="left", color="#a0522d")
        else:
            edge = math.radians(22)
            arrow(one, (0, 0), (-1.3 * math.sin(edge), 1.3 * math.cos(edge)), FORCE, "force",
                  (0, 0.13))
            arrow(one, (0.34, 0.2), (0.95, 0.2), CORE, "slides", (0.02, 0.17))
            one.text(0.62, 1.12, "atan(dynamic)", ha="left", color="#a0522d")
        one.text(0, -1.35, f"the pull is {name}", ha="center")
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
    free.text(0, -1.35, "each with stiffness K, at most F", ha="center")
    return figure


def state(axes, place, name, colour):
    """Place with its symbol."""
    axes.plot(*place, "o", color=colour, markersize=5, zorder=4)
    axes.text(place[0] + 0.13, place[1], name, color=colour, va="center")


def proxy(_):
    """Symbols of docs/coupling.md: free motion, contact with friction, and a rigid tool."""
    figure, axes = panels(("no contact: no force", "contact: a spring, and friction",
                           "rigid tool: a second spring"), 3.2)
    for one in axes:
        one.set(xlim=(-1.9, 1.9), ylim=(-1.65, 1.7))
        one.add_patch(patches.Polygon([(-1.9, -0.4), (1.9, -0.4), (1.9, -1.65), (-1.9, -1.65)],
                                      closed=True, color=SURFACE, linewidth=0))
    axes[0].add_patch(patches.Circle((0, 0.75), 0.4, color=ROUND, linewidth=0))
    state(axes[0], (0, 0.75), "$x_p = x_d$", CORE)
    axes[0].text(0, -1.5, "$F = 0$", color=FORCE, ha="center")

    place, hand = (-0.35, 0.0), (0.25, -0.95)
    contact = axes[1]
    contact.add_patch(patches.Circle(place, 0.4, color=ROUND, linewidth=0))
    spring(contact, hand, place)
    state(contact, hand, "$x_d$", HAND)
    contact.plot(*place, "o", color=CORE, markersize=5, zorder=4)
    contact.text(place[0] - 0.3, place[1], "$x_p$", color=CORE, va="center", ha="center")
    arrow(contact, place, (place[0] - 0.72, place[1] + 1.14), FORCE, "$F$", (-0.12, 0.14))
    arrow(contact, place, (place[0], place[1] + 1.14), "#a0522d", "$K\\,d\\,n$", (0.32, 0.1))
    measure(contact, (1.15, 0.0), (1.15, -0.95), "$d$", (0.16, 0))
    measure(contact, (-0.35, -1.2), (0.25, -1.2), "$s$", (0, -0.16))
    for height in (0.0, -0.95):
        contact.plot((0.0 if height else -0.35, 1.2), (height,) * 2, color="#aaaaaa", linewidth=0.6,
                     linestyle=":")
    contact.plot((-0.35, -0.35), (0, -1.25), color="#aaaaaa", linewidth=0.6, linestyle=":")
    contact.plot((0.25, 0.25), (-0.95, -1.25), color="#aaaaaa", linewidth=0.6, linestyle=":")

    rigid = axes[2]
    brick = [(-0.75, -0.25), (0.75, -0.25), (0.75, 0.25), (-0.75, 0.25)]
    rigid.add_patch(solid(turned(brick, (0, -0.15), 0)))
    rigid.add_patch(patches.Polygon(turned(brick, (0.1, -0.75), 0.45), closed=True, fill=False,
                                    edgecolor=HAND, linestyle="--"))
    spring(rigid, (0.1, -0.75), (0, -0.15), 4)
    arrow(rigid, (0, -0.15), (-0.15, 1.15), FORCE, "$F = K\\,(x_p - x_d)$", (0.35, 0.15))
    rigid.add_patch(patches.Arc((0, -0.15), 2.3, 2.3, theta1=5, theta2=40, color=FORCE,
                                linewidth=1.4))
    arrow(rigid, (1.147, 0.05), (1.15, -0.05), FORCE, "$M = K_r\\,\\theta$", (0.2, 0.68))
    rigid.text(0.1, -1.5, "$R_d$; $\\theta$ rotates it to $R_p$", color=HAND, ha="center")
    return figure


# Classes of docs/stability.md: damping in N s/m, stiffness in N/m that the maker gives.
CLASSES = {"touch": (0.25, 400), "omega, delta": (1.7, 5000)}


def stiffness(_):
    """Largest stable stiffness over the device's damping, by rate and delay."""
    figure, axes = pyplot.subplots(1, 2, figsize=(9.6, 3.0), sharey=True)
    figure.subplots_adjust(left=0.07, right=0.985, top=0.9, bottom=0.16, wspace=0.06)
    for one, rate in zip(axes, (1000, 4000)):
        for delay, colour in ((0.0, CORE), (1e-4, FORCE), (4e-4, "#009e73")):
            slope = 0.9 * 2 / (1 / rate + 2 * delay)
            one.plot((0, 2), (0, 2 * slope), color=colour, linewidth=1.4,
                     label=f"$t$ = {1e3 * delay:.1f} ms")
        for name, (damping, most) in CLASSES.items():
            limit = min(1.8 * damping * rate, most)
            one.plot(damping, limit, "o", color="black", markersize=4, zorder=4)
            one.annotate(name, (damping, limit), (-50, 6) if damping > 1 else (6, -9),
                         textcoords="offset points")
        one.set(title=f"{rate // 1000} kHz", xlabel="damping of the device $b$, N s/m",
                xlim=(0, 2), xticks=(0, 0.5, 1, 1.5),
                ylim=(0, 6000))
        one.grid(color="#dddddd")
    axes[0].set_ylabel("stiffness limit, N/m")
    axes[0].legend(frameon=False, loc="upper left")
    axes[1].legend(frameon=False, loc="lower right")
    return figure


FADE_MS, RISE_MS = 50, 100  # kFadeTime_s and kRiseTime_s of rt_core/limits.hpp.


def fault(_):
    """Force over time: a cause that lasts, one bad sample, and a loop that hangs."""
    figure, axes = pyplot.subplots(1, 3, figsize=(9.6, 2.7), sharey=True)
    figure.subplots_adjust(left=0.06, right=0.99, top=0.9, bottom=0.18, wspace=0.06)
    for one, title, until in ((axes[0], "a cause that lasts 80 ms", 100),
                              (axes[1], "one bad sample", 21)):
        gains, gain = [], 1.0
        for time in range(260):
            gain = (max(gain - 1 / FADE_MS, 0) if 20 <= time < until else
                    min(gain + 1 / RISE_MS, 1))
            gains.append(100 * gain)
        one.axvspan(20, until, color="#f6d8c6", linewidth=0)
        one.plot(range(260), gains, color=FORCE, linewidth=1.4)
        one.set(title=title)
    axes[0].text(22, 6, "cause")
    axes[0].annotate("fade, 50 ms", (45, 50), (55, 60), arrowprops={"arrowstyle": "-"})
    axes[0].annotate("rise, 100 ms", (150, 50), (165, 40), arrowprops={"arrowstyle": "-"})
    axes[1].annotate("2 % less for 1 ms, back after 2 ms", (20, 98), (40, 60),
                     arrowprops={"arrowstyle": "-"})
    beats, silent = 20, 3
    axes[2].plot((0, beats + silent, beats + silent + FADE_MS, 260), (100, 100, 0, 0), color=FORCE,
                 linewidth=1.4)
    axes[2].axvspan(beats, 260, color="#f6d8c6", linewidth=0)
    axes[2].annotate("last heartbeat", (beats, 100), (40, 92), arrowprops={"arrowstyle": "-"})
    axes[2].annotate("after 3 periods: the supervisor fades", (48, 50), (62, 60),
                     arrowprops={"arrowstyle": "-"})
    axes[2].annotate("brake()", (beats + silent + FADE_MS, 0), (95, 18),
                     arrowprops={"arrowstyle": "-"})
    axes[2].set(title="the loop hangs, PREEMPT_RT kernel")
    for one in axes:
        one.set(xlabel="time, ms", xlim=(0, 260), ylim=(-3, 108))
        one.grid(color="#dddddd")
    axes[0].set_ylabel("force, %")
    return figure


def part(axes, place, size, title, words, colour=ROUND):
    """Box with a title and lines of text."""
    axes.add_patch(patches.FancyBboxPatch(place, *size, boxstyle="round,pad=0,rounding_size=0.06",
                                          facecolor=colour, edgecolor="#333333", linewidth=0.8))
    middle = place[0] + size[0] / 2
    axes.text(middle, place[1] + size[1] - 0.2, title, ha="center", va="center", weight="bold")
    axes.text(middle, place[1] + (size[1] - 0.3) / 2, words, ha="center", va="center")


def link(axes, start, end, name, offset=(0, 0.12)):
    axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": "#333333",
                                              "linewidth": 1.2, "shrinkA": 0, "shrinkB": 0})
    axes.text((start[0] + end[0]) / 2 + offset[0], (start[1] + end[1]) / 2 + offset[1], name,
              ha="center", va="center")


def system(_):
    """Path of a mesh from its file to the device."""
    figure, axes = pyplot.subplots(figsize=(9.6, 3.3))
    figure.subplots_adjust(left=0.005, right=0.995, top=0.99, bottom=0.01)
    axes.set(xlim=(0, 12), ylim=(0, 4.1))
    axes.axis("off")
    part(axes, (0.1, 2.75), (1.5, 1.0), "mesh file", "PLY, OBJ,\nSTL, OFF", SURFACE)
    part(axes, (0.1, 0.5), (1.5, 1.1), "model file", ".spm, about\n4.5 B a face", SURFACE)
    part(axes, (2.6, 0.5), (1.9, 1.1), "spm_publish", "model server,\nwhole model")
    axes.add_patch(patches.FancyBboxPatch((5.7, 0.1), 4.0, 3.85,
                                          boxstyle="round,pad=0,rounding_size=0.06",
                                          facecolor="#f7f7f7", edgecolor="#333333", linewidth=0.8))
    axes.text(7.7, 3.72, "hrtc, the controller", ha="center", va="center", weight="bold")
    part(axes, (5.9, 0.5), (1.6, 1.1), "transport thread", "checks data,\nevery 0.3 ms")
    part(axes, (7.95, 0.5), (1.6, 1.1), "pools", "2 MiB: coarse\nmodel, fine\nat the tool",
         "#e5f2e5")
    part(axes, (7.95, 2.1), (1.6, 1.25), "haptic thread", "refine, query,\nforce: every\n1 ms")
    part(axes, (5.9, 2.1), (1.6, 1.25), "supervisor", "watches the\nloop, brakes\nthe device")
    part(axes, (10.5, 2.1), (1.4, 1.25), "device", "position in,\nforce out", SURFACE)
    link(axes, (0.85, 2.75), (0.85, 1.6), "spm_build", (0.55, 0))
    link(axes, (1.6, 1.05), (2.6, 1.05), "reads")
    link(axes, (4.5, 1.2), (5.9, 1.2), "chunks, DDS")
    link(axes, (5.9, 0.85), (4.5, 0.85), "requests", (0, -0.14))
    link(axes, (7.5, 1.05), (7.95, 1.05), "")
    link(axes, (8.75, 1.6), (8.75, 2.1), "")
    link(axes, (7.95, 2.5), (7.5, 2.5), "")
    link(axes, (9.55, 2.9), (10.5, 2.9), "force", (0.08, 0.12))
    link(axes, (10.5, 2.5), (9.55, 2.5), "position", (0.08, -0.14))
    return figure


if __name__ == "__main__":
    sys.exit(plots.run(sys.argv[1:], __doc__,
                       (shapes, coupling, proxy, stiffness, fault, system), lambda _: None))
