#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""Makes the pictures of the pages from what the programs do.

    pictures.py [--quick] [--scratch DIR] BIN_DIR FOLDER [NAME...]    FOLDER/NAME, by default all

Runs of hrtc in virtual time are recorded; spm_view replays them and tells each frame's faces, boxes
and forces; spm_inspect tells the true distances, coarser meshes and records; a trace tells times.
--quick takes small models and few frames, to see that all still works; models and recordings that
are in DIR are taken as they are. Needs python3-matplotlib, which brings Pillow.
Exit codes: 0 done, 2 failed, 3 usage, 77 matplotlib is not here.
"""

import argparse
import csv
import io
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import time
import urllib.parse
import urllib.request

try:
    import matplotlib
    matplotlib.use("agg")
    from matplotlib import collections, pyplot
    import numpy
    from PIL import Image
except ImportError:
    print("no python3-matplotlib")
    sys.exit(77)

PATIENCE_S = 900
# Colours of spm_view's page: base mesh to finest level.
RAMP = numpy.array([[168, 178, 196], [96, 146, 208], [46, 168, 158], [244, 190, 66],
                    [222, 88, 62]]) / 255
TOOL, FORCE = "#d8822b", "#c94c4c"
LOADED, PREDICTED, PRESENT, TREE = "#2f9e6e", "#a855c7", "#c94c4c", "#3b78d8"
RADIUS_M = 0.002
LIGHT = numpy.array([0.35, 0.45, 0.82])


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True,
                          timeout=PATIENCE_S)
    if done.returncode != 0:
        sys.exit(f"pictures: {command[0]} ended with {done.returncode}: {done.stderr.strip()}")
    return done.stdout


class Cut:
    """Faces of a model: corners as points, level of each face."""

    def __init__(self, points, corners, levels):
        self.triangles = points[corners]
        self.levels = levels

    @classmethod
    def of_answer(cls, data):
        """/front of spm_view, described in host_tools/spm_view/cut.hpp."""
        vertices, faces = struct.unpack_from("<II", data)
        at = 8
        points = numpy.frombuffer(data, "<f4", 3 * vertices, at).reshape(-1, 3).astype(float)
        at += 12 * vertices
        corners = numpy.frombuffer(data, "<u4", 3 * faces, at).reshape(-1, 3)
        at += 12 * faces + 4 * faces
        return cls(points, corners, numpy.frombuffer(data, "<u2", faces, at).astype(float))

    @classmethod
    def of_obj(cls, path):
        points, corners = [], []
        for line in path.read_text().splitlines():
            kind, *rest = line.split() or [""]
            if kind == "v":
                points.append([float(word) for word in rest[:3]])
            elif kind == "f":
                corners.append([int(word.split("/")[0]) - 1 for word in rest[:3]])
        return cls(numpy.array(points), numpy.array(corners), numpy.zeros(len(corners)))


class Film:
    """Recording, as spm_view shows it."""

    def __init__(self, programs, recording):
        self.log = recording.with_suffix(".log")
        with open(self.log, "wb") as log:
            self.process = subprocess.Popen([programs / "spm_view", "--replay", recording, "--port",
                                             "0"], stdout=log, stderr=subprocess.STDOUT)
        end = time.monotonic() + PATIENCE_S
        while not (found := re.search(r"(http://\S+) shows", self.log.read_text())):
            if self.process.poll() is not None or time.monotonic() > end:
                sys.exit(f"pictures: spm_view doesn't show {recording}: {self.log.read_text()}")
            time.sleep(0.1)
        self.url = found.group(1)

    def end(self):
        self.process.terminate()
        self.process.wait()

    def get(self, path, **asked):
        query = urllib.parse.urlencode(asked)
        with urllib.request.urlopen(f"{self.url}{path}?{query}", timeout=PATIENCE_S) as answer:
            return answer.read()

    def state(self, frame):
        return json.loads(self.get("state", frame=frame))["controller"]

    def of_model(self, path, state, model, **more):
        return self.get(path, controller=state["id"], serial=state["front"]["serial"], model=model,
                        **more)

    def cut(self, state, model):
        return Cut.of_answer(self.of_model("front", state, model))

    def boxes(self, path, state, model, **more):
        """Low and high corners, one pair a box."""
        data = self.of_model(path, state, model, **more)
        count, = struct.unpack_from("<I", data)
        return numpy.frombuffer(data, "<f4", 6 * count, 4).reshape(-1, 2, 3).astype(float)


class Camera:
    """View without perspective: x to the right, y up, z towards the eye."""

    def __init__(self, towards_eye, up=(0.0, 0.0, 1.0)):
        z = numpy.array(towards_eye, float)
        z /= numpy.linalg.norm(z)
        x = numpy.cross(up, z)
        x /= numpy.linalg.norm(x)
        self.axes = numpy.array([x, numpy.cross(z, x), z])

    def see(self, points):
        return numpy.asarray(points) @ self.axes.T


def turned(points, object_):
    """Transform from the model's frame to the world's."""
    x, y, z, w = object_["rotation"]
    matrix = numpy.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    return object_["scale"] * (points @ matrix.T) + numpy.array(object_["translation_m"])


def ramp(shares):
    place = numpy.clip(shares, 0, 1) * (len(RAMP) - 1)
    left = numpy.minimum(place.astype(int), len(RAMP) - 2)
    part = (place - left)[:, None]
    return RAMP[left] * (1 - part) + RAMP[left + 1] * part


def faces(axes, camera, triangles, colours, edge=0.15, within=None):
    """Faces towards the eye, the nearest last. `within`: low and high of visible points."""
    seen = camera.see(triangles)
    normals = numpy.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    lengths = numpy.linalg.norm(normals, axis=1)
    normals = normals / numpy.maximum(lengths, 1e-30)[:, None]
    shown = (normals @ camera.axes[2] > 0) & (lengths > 0)
    if within is not None:
        low, high = within
        shown &= (seen[:, :, :2].max(axis=1) >= low).all(axis=1)
        shown &= (seen[:, :, :2].min(axis=1) <= high).all(axis=1)
    seen, normals, colours = seen[shown], normals[shown], colours[shown]
    order = numpy.argsort(seen[:, :, 2].mean(axis=1))
    light = 0.45 + 0.55 * numpy.clip(camera.see(normals) @ (LIGHT / numpy.linalg.norm(LIGHT)), 0, 1)
    shaded = numpy.clip(colours * light[:, None], 0, 1)[order]
    drawn = collections.PolyCollection(
        seen[order][:, :, :2], facecolors=shaded,
        edgecolors=shaded * 0.72 if edge > 0 else shaded, linewidths=edge if edge > 0 else 0.1)
    axes.add_collection(drawn)


def box_lines(axes, camera, boxes, colour, width=0.6, alpha=0.8):
    edges = []
    for axis in range(3):
        for corner in range(4):
            ends = []
            for end in range(2):
                side = [0, 0, 0]
                side[axis] = end
                side[(axis + 1) % 3] = corner & 1
                side[(axis + 2) % 3] = corner >> 1
                ends.append(numpy.stack([boxes[:, side[i], i] for i in range(3)], axis=1))
            edges.append(numpy.stack(ends, axis=1))
    lines = camera.see(numpy.concatenate(edges))[:, :, :2]
    axes.add_collection(collections.LineCollection(lines, colors=colour, linewidths=width,
                                                   alpha=alpha))


def frame_axes(axes, middle, half, ratio=1.0):
    """Shows a region of this size around a visible point."""
    axes.set(xlim=(middle[0] - half * ratio, middle[0] + half * ratio),
             ylim=(middle[1] - half, middle[1] + half), aspect="equal")
    axes.axis("off")


def window(middle, half, ratio=1.0):
    return (numpy.array([middle[0] - half * ratio, middle[1] - half]),
            numpy.array([middle[0] + half * ratio, middle[1] + half]))


def touch_spans(axes, seconds, touching):
    """Pale background where the condition holds."""
    edges = numpy.flatnonzero(numpy.diff(numpy.concatenate([[0], touching.astype(int), [0]])))
    for begin, end in edges.reshape(-1, 2):
        axes.axvspan(seconds[begin], seconds[end - 1], color="#f6e9d8", linewidth=0, zorder=0)


def tool_mark(axes, camera, tool, scale_m_per_n):
    """Proxy, and the force on the hand as an arrow."""
    place = camera.see(tool["proxy_m"])
    axes.add_patch(pyplot.Circle(place[:2], tool["radius_m"], facecolor=TOOL, edgecolor="#5c3510",
                                 linewidth=0.8, zorder=4))
    force = camera.see(tool["force_n"]) * scale_m_per_n
    if numpy.linalg.norm(force) > 1e-9:
        axes.annotate("", place[:2] + force[:2], place[:2], zorder=5,
                      arrowprops={"arrowstyle": "-|>", "color": FORCE, "linewidth": 2.2,
                                  "shrinkA": 0, "shrinkB": 0, "mutation_scale": 14})


def to_image(figure, dpi=100):
    data = io.BytesIO()
    figure.savefig(data, format="png", dpi=dpi, facecolor="white")
    pyplot.close(figure)
    return Image.open(io.BytesIO(data.getvalue())).convert("RGB")


def save(figure, path, dpi=110):
    """Compresses a picture of few colours; significant colours stay exact."""
    image = to_image(figure, dpi)
    colours = [[round(255 * part) for part in colour] for colour in (
        *RAMP, *map(matplotlib.colors.to_rgb, (
            "white", "black", TOOL, FORCE, LOADED, PREDICTED, PRESENT, TREE)))]
    palette = Image.new("P", (1, 1))
    palette.putpalette(sum(colours, []) + image.quantize(160).getpalette()[:3 * 160])
    # The palette's nearest colour is only approximate.
    places = numpy.array(image.quantize(palette=palette, dither=Image.Dither.NONE))
    for place, colour in enumerate(colours):
        places[(numpy.asarray(image) == colour).all(axis=2)] = place
    exact = Image.fromarray(places, "P")
    exact.putpalette(palette.getpalette())
    exact.save(path, optimize=True)


class Take:
    """Recorded run: the content and the figures of its frames."""

    def __init__(self, studio, recording):
        self.studio, self.recording = studio, recording

    def film(self):
        return self.studio.film_of(self.recording)

    def rows(self):
        """Run, frame by frame."""
        def make():
            path = self.studio.file(f"{self.recording.stem}.csv", lambda to: run(
                self.studio.programs / "hrtc", "--replay", self.recording, "--export", to))
            with open(path, newline="") as file:
                return list(csv.DictReader(file))
        return self.studio.once(f"rows {self.recording}", make)

    def column(self, name):
        return numpy.array([float(row[name] or "nan") for row in self.rows()])

    def points(self, name):
        return numpy.stack([self.column(f"{name}.{axis}") for axis in "xyz"], axis=1)

    def forces(self):
        return numpy.linalg.norm(self.points("tool0.sent_force_world_n"), axis=1)

    def pressing(self):
        """Frame in the middle of the longest touch."""
        touching = numpy.concatenate([[0], (self.forces() > 0.2).astype(int), [0]])
        begins = numpy.flatnonzero(numpy.diff(touching) == 1)
        ends = numpy.flatnonzero(numpy.diff(touching) == -1)
        if len(begins) == 0:
            sys.exit("pictures: the hand touched nothing")
        longest = numpy.argmax(ends - begins)
        return int((begins[longest] + ends[longest]) // 2)


class Studio:
    """Models, recordings and results, made at the first request."""

    def __init__(self, programs, folder, quick):
        self.programs, self.folder, self.quick = programs, folder, quick
        self.made = {}
        self.films = []

    def file(self, name, make):
        """File of the scratch folder, made by `make(path)` unless it exists."""
        path = self.folder / name
        if not path.exists():
            make(path)
        return path

    def once(self, name, make):
        if name not in self.made:
            self.made[name] = make()
        return self.made[name]

    def model(self):
        return self.file("bumpy.spm", lambda path: run(
            self.programs / "spm_build", "--shape", "bumpy-sphere", "--faces",
            5_000 if self.quick else 40_000, "-o", path))

    def figures(self, model, *words):
        """Output of spm_inspect for a model."""
        return self.once(f"figures {model} {words}", lambda: json.loads(run(
            self.programs / "spm_inspect", model, "--json", *words)))

    def faces(self):
        """Number of faces of the model's source mesh."""
        return self.figures(self.model())["faces"]

    def play(self, name, *words):
        """Recorded run of hrtc in virtual time."""
        recording = self.file(f"{name}.rec", lambda path: run(
            self.programs / "hrtc", *words, "--device", "sim", "--virtual-time", "--allow-no-rt",
            "--record", path))
        return self.once(f"take {name}", lambda: Take(self, recording))

    def touch(self):
        """Hand that flies, lands, slides and lifts off, as in the demo."""
        return self.play("touch", self.model(), "--no-static", "--tool", f"sphere:{RADIUS_M}",
                         "--duration", "1" if self.quick else "3")

    def film_of(self, recording):
        def make():
            self.films.append(Film(self.programs, recording))
            return self.films[-1]
        return self.once(f"film {recording}", make)

    def end(self):
        for film in self.films:
            film.end()


def shown(film, frame):
    """State, its only object, the cut in the world and its colours."""
    state = film.state(frame)
    object_ = state["front"]["objects"][0]
    cut = film.cut(state, object_["model"])
    colours = ramp(cut.levels / max(cut.levels.max(), 1))
    return state, object_, turned(cut.triangles, object_), colours


def camera_on(tool):
    """View from the tool's side, slightly beside it: the tool is to the right of the model's
    middle."""
    outward = numpy.array(tool["proxy_m"], float)
    outward /= numpy.linalg.norm(outward)
    aside = numpy.cross((0.0, 0.0, 1.0), outward)
    return Camera(outward + 0.45 * aside / max(numpy.linalg.norm(aside), 1e-9) +
                  numpy.array([0.0, 0.0, 0.3]))


def touch(studio, path):
    """Animation: the cut follows the tool; below, force and faces over time."""
    take = studio.touch()
    film, forces = take.film(), take.forces()
    middle = take.pressing()
    count, step = (4, 40) if studio.quick else (50, 40)
    first = max(0, min(middle - count * step // 2, len(forces) - count * step - 1))
    frames = [first + i * step for i in range(count)]
    states = [shown(film, frame) for frame in frames]
    camera = camera_on(film.state(middle)["tools"][0])
    centre = camera.see(film.state(middle)["tools"][0]["proxy_m"])
    radius_m = numpy.linalg.norm(states[0][2].reshape(-1, 3), axis=1).max()
    half, ratio = 0.42 * radius_m, 1.62
    active = numpy.array([len(triangles) for _, _, triangles, _ in states])
    seconds = numpy.arange(frames[0], frames[-1] + 1) * 1e-3
    images = []
    for i, (state, _, triangles, colours) in enumerate(states):
        figure = pyplot.figure(figsize=(7.2, 5.4))
        axes = figure.add_axes((0, 0.2, 1, 0.8))
        faces(axes, camera, triangles, colours, edge=0.25, within=window(centre, half, ratio))
        tool_mark(axes, camera, state["tools"][0], 0.15 * radius_m)
        frame_axes(axes, centre, half, ratio)
        axes.text(0.015, 0.955, f"{active[i]:,} of {studio.faces():,} faces", fontsize=11,
                  transform=axes.transAxes)
        plot = figure.add_axes((0.075, 0.075, 0.905, 0.125))
        plot.plot(seconds, forces[frames[0]:frames[-1] + 1], color="#d9b3b3", linewidth=1)
        until = frames[i] - frames[0] + 1
        plot.plot(seconds[:until], forces[frames[0]:frames[i] + 1], color=FORCE, linewidth=1.4)
        plot.set(xlim=(seconds[0], seconds[-1]), ylim=(0, None))
        plot.set_ylabel("force, N", fontsize=8)
        plot.tick_params(labelsize=8)
        plot.spines[["top", "right"]].set_visible(False)
        images.append(to_image(figure))
    palette = images[len(images) // 2].quantize(64, dither=Image.Dither.NONE)
    images = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images]
    images[0].save(path, save_all=True, append_images=images[1:], duration=80, loop=0,
                   optimize=True)


def cut(studio, path):
    """Whole cut, and a part of it at the tool."""
    take = studio.touch()
    state, _, triangles, colours = shown(take.film(), take.pressing())
    tool = state["tools"][0]
    camera = camera_on(tool)
    radius_m = numpy.linalg.norm(triangles.reshape(-1, 3), axis=1).max()
    place = camera.see(tool["proxy_m"])
    figure, axes = pyplot.subplots(1, 2, figsize=(9.6, 4.9))
    figure.subplots_adjust(0.005, 0.0, 0.995, 0.93, wspace=0.02)
    faces(axes[0], camera, triangles, colours)
    frame_axes(axes[0], (0, 0), 1.05 * radius_m)
    tool_mark(axes[0], camera, tool, 0.25 * radius_m)
    half = 7 * RADIUS_M
    faces(axes[1], camera, triangles, colours, edge=0.5, within=window(place, half))
    tool_mark(axes[1], camera, tool, 4 * RADIUS_M)
    frame_axes(axes[1], place, half)
    axes[0].add_patch(pyplot.Rectangle(place[:2] - half, 2 * half, 2 * half, fill=False,
                                       linewidth=1))
    axes[0].set_title(f"{len(triangles):,} active faces of {studio.faces():,}", fontsize=11)
    axes[1].set_title(f"{2e3 * half:.0f} mm around a tool of {1e3 * RADIUS_M:.0f} mm",
                      fontsize=11)
    save(figure, path)


def levels(studio, path):
    """One model at four sizes."""
    counts = [0, 2_000, 10_000, studio.faces()]
    figure, axes = pyplot.subplots(1, 4, figsize=(9.6, 2.75))
    figure.subplots_adjust(0.0, 0.0, 1.0, 0.9, wspace=0.0)
    camera = Camera((0.6, -0.7, 0.45))
    for one, count in zip(axes, counts):
        out = studio.folder / f"{count}.obj"
        run(studio.programs / "spm_inspect", studio.model(), "--extract", "--faces",
            max(count, 1_000 if studio.quick else 500), "-o", out)
        mesh = Cut.of_obj(out)
        triangles = mesh.triangles - mesh.triangles.reshape(-1, 3).mean(axis=0)
        radius_m = numpy.linalg.norm(triangles.reshape(-1, 3), axis=1).max()
        grey = numpy.tile(RAMP[1], (len(triangles), 1))
        faces(one, camera, triangles, grey, edge=0.3 if len(triangles) < 10_000 else
              0.08 if len(triangles) < 50_000 else 0)
        frame_axes(one, (0, 0), 1.02 * radius_m)
        one.set_title(f"{len(triangles):,} faces", fontsize=11)
    save(figure, path)


def tree(studio, path):
    """Boxes of the AB-Tree at some levels over the cut."""
    film = studio.touch().film()
    state, object_, triangles, colours = shown(film, studio.touch().pressing())
    camera = camera_on(state["tools"][0])
    radius_m = numpy.linalg.norm(triangles.reshape(-1, 3), axis=1).max()
    figure, axes = pyplot.subplots(1, 4, figsize=(9.6, 2.85))
    figure.subplots_adjust(0.0, 0.0, 1.0, 0.88, wspace=0.0)
    pale = 0.5 + 0.5 * colours
    for one, level in zip(axes, (1, 2, 3, 24)):
        boxes = film.boxes("boxes", state, object_["model"], level=level)
        # The object is not rotated: its boxes stay boxes.
        moved = turned(boxes.reshape(-1, 3), object_).reshape(-1, 2, 3)
        faces(one, camera, triangles, pale, edge=0)
        box_lines(one, camera, moved, TREE, 0.7 if len(boxes) < 200 else 0.25)
        frame_axes(one, (0, 0), 1.25 * radius_m)
        name = "leaves" if level == 24 else f"level {level}"
        one.set_title(f"{name}: {len(boxes):,} boxes", fontsize=11)
    save(figure, path)


def regions(studio, path):
    """Search regions of chunks, and the boxes of loaded ones."""
    film = studio.touch().film()
    state, object_, triangles, colours = shown(film, studio.touch().pressing())
    camera = camera_on(state["tools"][0])
    place = camera.see(state["tools"][0]["proxy_m"])
    radius_m = numpy.linalg.norm(triangles.reshape(-1, 3), axis=1).max()
    loaded = film.boxes("loaded", state, object_["model"])
    moved = turned(loaded.reshape(-1, 3), object_).reshape(-1, 2, 3)
    figure, axes = pyplot.subplots(1, 2, figsize=(9.6, 4.9))
    figure.subplots_adjust(0.005, 0.0, 0.995, 0.93, wspace=0.02)
    half = 3 * RADIUS_M
    faces(axes[0], camera, triangles, 0.4 + 0.6 * colours)
    box_lines(axes[0], camera, moved, LOADED, 0.5, 0.6)
    frame_axes(axes[0], (0, 0), 1.1 * radius_m)
    axes[0].set_title(f"boxes of the {len(loaded)} loaded chunks", fontsize=11)
    faces(axes[1], camera, triangles, 0.4 + 0.6 * colours, edge=0.4, within=window(place, half))
    for region in state["front"]["regions"][::-1]:
        centre = camera.see(turned(numpy.array([region["center_m"]]), object_)[0])
        axes[1].add_patch(pyplot.Circle(
            centre[:2], region["radius_m"], fill=False, linewidth=1.8, zorder=6,
            color=PREDICTED if region["is_predicted"] else PRESENT))
    tool_mark(axes[1], camera, state["tools"][0], 0)
    frame_axes(axes[1], place, half)
    axes[1].set_title("where chunks are searched: at the tool, predicted", fontsize=11)
    save(figure, path)


def bracket(studio, path):
    """L and U against the true distance while the tool approaches."""
    take = studio.touch()
    lower = take.column("tool0.nearest.lower_m")
    upper = take.column("tool0.nearest.upper_m")
    kinds = numpy.array([row["tool0.nearest.answer"] for row in take.rows()])
    landed = int(numpy.argmax(take.forces() > 0.05))
    begin, end = max(0, landed - (300 if studio.quick else 700)), landed + 150
    frames = numpy.arange(begin, min(end, len(lower)))
    frames = frames[numpy.isfinite(lower[frames]) & numpy.isfinite(upper[frames])]
    places = studio.folder / "places.txt"
    places.write_text("".join(" ".join(repr(float(x)) for x in point) + "\n" for point in
                              take.points("tool0.nearest.point_world_m")[frames]))
    told = run(studio.programs / "spm_inspect", studio.model(), "--distances", places)
    true = numpy.array([float(line.split()[0]) for line in told.splitlines()
                        if not line.startswith("#")])
    rounding = 1e-9
    if not ((lower[frames] <= true + rounding) & (true <= upper[frames] + rounding)).all():
        sys.exit("pictures: the bounds don't hold the true distance")
    seconds = frames * 1e-3
    figure, axes = pyplot.subplots(2, 1, figsize=(9.0, 4.6), sharex=True,
                                   gridspec_kw={"height_ratios": [2, 1]})
    figure.subplots_adjust(0.075, 0.1, 0.985, 0.97, hspace=0.12)
    axes[0].fill_between(seconds, 1e3 * lower[frames], 1e3 * upper[frames], color="#a8c4ea",
                         label="proven bounds L and U", linewidth=0)
    axes[0].plot(seconds, 1e3 * true, color="black", linewidth=1, label="true distance")
    axes[0].set_ylabel("distance of the centre, mm")
    axes[0].legend(frameon=False)
    for kind, colour in (("separated", "#3b78d8"), ("exact", "#2f9e6e"), ("bounded", "#d8822b")):
        of_kind = kinds[frames] == kind
        if of_kind.any():
            axes[1].plot(seconds[of_kind], 1e3 * (upper - lower)[frames][of_kind], ".",
                         markersize=3, color=colour, label=kind)
    axes[1].set(xlabel="time, s", ylabel="U - L, mm")
    axes[1].legend(frameon=False, ncol=3)
    for one in axes:
        one.grid(color="#dddddd")
    save(figure, path)


def force(studio, path):
    """Force on the hand, and the frame's work for it."""
    take = studio.touch()
    seconds = numpy.arange(len(take.rows())) * 1e-3
    figure, axes = pyplot.subplots(3, 1, figsize=(9.0, 4.6), sharex=True)
    figure.subplots_adjust(0.075, 0.1, 0.985, 0.97, hspace=0.14)
    axes[0].plot(seconds, take.forces(), color=FORCE, linewidth=1)
    axes[0].set_ylabel("force, N")
    axes[1].plot(seconds, take.column("model0.faces_used"), color=TREE, linewidth=1)
    axes[1].set_ylabel("active faces")
    axes[2].plot(seconds, take.column("splits"), color=LOADED, linewidth=0.8, label="splits")
    axes[2].plot(seconds, take.column("merges"), color=PREDICTED, linewidth=0.8, label="merges")
    axes[2].set(xlabel="time, s", ylabel="per frame")
    axes[2].legend(frameon=False, ncol=2)
    for one in axes:
        one.grid(color="#dddddd")
    save(figure, path)


def scene(studio, path):
    """Objects of a scene, coarse except at a hand."""
    root = pathlib.Path(__file__).resolve().parents[2]
    size = ("--models", "4", "--objects", "12", "--faces", "2000") if studio.quick else ()
    glb = studio.file("scene.glb", lambda to: run(sys.executable, root / "cmake/demo_scene.py", to,
                                                  *size))
    folder = studio.file("scene", lambda to: run(studio.programs / "spm_build", glb, "-o", to))
    film = studio.play("scene", folder / "scene.gltf", "--tools", "2", "--pool-mib", "8",
                       "--duration", "1" if studio.quick else "3").film()
    frame = json.loads(film.get("state"))["film"]["frames"] * 3 // 5
    state = film.state(frame)
    camera = Camera((0.15, -0.75, 0.8))
    triangles, colours = [], []
    cuts = {}
    for object_ in state["front"]["objects"]:
        model = object_["model"]
        if model not in cuts:
            cuts[model] = film.cut(state, model)
        levels_of = cuts[model].levels
        triangles.append(turned(cuts[model].triangles, object_))
        colours.append(ramp(levels_of / 12))
    triangles, colours = numpy.concatenate(triangles), numpy.concatenate(colours)
    seen = camera.see(triangles.reshape(-1, 3))
    low, high = seen[:, :2].min(axis=0), seen[:, :2].max(axis=0)
    near, near_half = camera.see(state["tools"][0]["proxy_m"])[:2], 0.03
    figure, axes = pyplot.subplots(1, 2, figsize=(9.6, 4.9))
    figure.subplots_adjust(0.005, 0.0, 0.995, 0.93, wspace=0.02)
    faces(axes[0], camera, triangles, colours, edge=0.1)
    frame_axes(axes[0], (low + high) / 2, 1.03 * max((high - low) / 2))
    axes[0].add_patch(pyplot.Rectangle(near - near_half, 2 * near_half, 2 * near_half, fill=False,
                                       linewidth=1))
    axes[0].set_title(f"{len(state['front']['objects'])} objects, {len(triangles):,} faces",
                      fontsize=11)
    faces(axes[1], camera, triangles, colours, edge=0.4, within=window(near, near_half))
    for tool in state["tools"]:
        tool_mark(axes[1], camera, tool, 0.02)
    frame_axes(axes[1], near, near_half)
    axes[1].set_title(f"{2e3 * near_half:.0f} mm around a tool", fontsize=11)
    save(figure, path)


def forest(studio, path):
    """Parents of the vertices, and the vertices present in one frame."""
    small = studio.file("small.spm", lambda to: run(
        studio.programs / "spm_build", "--shape", "bumpy-sphere", "--faces", 1_000, "--base-faces",
        60, "-o", to))
    take = studio.play("small", small, "--no-static", "--tool", "sphere:0.001", "--motion",
                       "approach", "--duration", "1" if studio.quick else "2")
    state, object_, triangles, colours = shown(take.film(), take.pressing())
    records = studio.figures(small, "--records")["record_list"]
    there = {tuple(numpy.round(corner, 7)) for corner in triangles.reshape(-1, 3)}
    split = {record["vertex"]: tuple(numpy.round(record["position_m"], 7)) in there
             for record in records}
    depth = {record["vertex"]: record["depth"] for record in records}
    children = {}
    for record in records:
        children.setdefault(record["parent"], []).append(record["vertex"])
    base = list(range(min(depth)))
    # A vertex is to the left of its children, the latest next to it: no lines cross.
    place, waiting = {}, base[::-1]
    while waiting:
        vertex = waiting.pop()
        place[vertex] = len(place)
        waiting.extend(sorted(children.get(vertex, []), key=lambda child: depth[child]))
    lowest = max(depth.values()) + 1
    figure, axes = pyplot.subplots(1, 2, figsize=(9.6, 3.6),
                                   gridspec_kw={"width_ratios": [1, 2.1]})
    figure.subplots_adjust(0.0, 0.02, 0.995, 0.92, wspace=0.12)
    camera = camera_on(state["tools"][0])
    radius_m = numpy.linalg.norm(triangles.reshape(-1, 3), axis=1).max()
    faces(axes[0], camera, triangles, colours, edge=0.4)
    tool_mark(axes[0], camera, state["tools"][0], 0)
    frame_axes(axes[0], (0, 0), 1.05 * radius_m)
    axes[0].set_title(f"{len(triangles):,} faces of a frame", fontsize=11)
    for is_split, width in ((False, 0.5), (True, 1.1)):
        some = [record for record in records if split[record["vertex"]] == is_split]
        lines = []
        for record in some:
            at, top = place[record["vertex"]], record["depth"]
            lines += [[(place[record["parent"]], top), (at, top)], [(at, top), (at, lowest)]]
        shade = ramp(numpy.array([record["depth"] for record in some]) /
                     max(depth[vertex] for vertex in depth if split[vertex]))
        axes[1].add_collection(collections.LineCollection(
            lines, linewidths=width, zorder=2 + is_split,
            colors=numpy.repeat(shade, 2, axis=0) if is_split else "#d5d9df"))
    axes[1].add_collection(collections.LineCollection(
        [[(place[vertex], 0), (place[vertex], lowest)] for vertex in base], colors=RAMP[:1],
        linewidths=0.9, zorder=1))
    axes[1].set(xlim=(-3, len(place) + 2), ylim=(lowest, -0.4), xticks=[], ylabel="depth")
    axes[1].spines[["top", "right", "bottom"]].set_visible(False)
    axes[1].set_title(f"{sum(split.values())} of {len(records)} records are split", fontsize=11)
    save(figure, path)


def chunks(studio, path):
    """Vertices that are loaded together: those of a chunk are of one tier and near each other."""
    records = studio.figures(studio.model(), "--records")["record_list"]
    points = numpy.array([record["position_m"] for record in records])
    out = studio.file("pale.obj", lambda to: run(
        studio.programs / "spm_inspect", studio.model(), "--extract", "--faces",
        1_000 if studio.quick else 4_000, "-o", to))
    surface = Cut.of_obj(out).triangles
    middle = surface.reshape(-1, 3).mean(axis=0)
    surface, points = surface - middle, points - middle
    camera = Camera((0.6, -0.7, 0.45))
    radius_m = numpy.linalg.norm(surface.reshape(-1, 3), axis=1).max()
    outward = points / numpy.linalg.norm(points, axis=1)[:, None]
    seen = camera.see(outward)[:, 2] > 0.12
    chunk = numpy.arange(len(points)) // 64
    last = chunk.max()
    figure, axes = pyplot.subplots(1, 4, figsize=(9.6, 2.75))
    figure.subplots_adjust(0.0, 0.0, 1.0, 0.9, wspace=0.0)
    inks = pyplot.get_cmap("tab20").colors
    for one, (begin, end) in zip(axes, ((0, 1), (1, last // 16), (last // 16, last // 4),
                                        (last // 4, last + 1))):
        here = seen & (chunk >= begin) & (chunk < max(end, begin + 1))
        faces(one, camera, surface, numpy.tile(RAMP[0], (len(surface), 1)) * 0.4 + 0.6, edge=0)
        at = camera.see(points[here])
        one.scatter(at[:, 0], at[:, 1], s=3.0 if here.sum() > 1_000 else 9.0, linewidths=0,
                    c=[inks[(7 * number) % 20] for number in chunk[here]], zorder=3)
        frame_axes(one, (0, 0), 1.02 * radius_m)
        count = max(end, begin + 1) - begin
        one.set_title(f"chunk {begin}" if count == 1 else
                      f"chunks {begin:,} to {begin + count - 1:,}", fontsize=11)
    save(figure, path)


def stages(studio, path):
    """Times of each frame's stages, on the machine that makes the picture."""
    trace = studio.file("touch.trace.json", lambda to: run(
        studio.programs / "hrtc", studio.model(), "--no-static", "--tool", f"sphere:{RADIUS_M}",
        "--device", "sim", "--allow-no-rt", "--duration", "1" if studio.quick else "3", "--trace",
        to))
    names = ("load", "refine", "refit", "query", "force")
    times, touching = {name: [] for name in names}, []
    for event in json.loads(trace.read_text())["traceEvents"]:
        if event["name"] == "frame":
            touching.append(event["args"]["in_contact"])
        elif event["name"] in times and event["ph"] == "X":
            times[event["name"]].append(event["dur"])
    touching = numpy.array(touching, bool)
    seconds = numpy.arange(len(touching)) * 1e-3
    window_frames = 21
    def smooth(values):
        padded = numpy.pad(values, window_frames // 2, mode="edge")
        return numpy.median(numpy.lib.stride_tricks.sliding_window_view(padded, window_frames),
                            axis=1)
    figure, axes = pyplot.subplots(figsize=(9.0, 3.4))
    figure.subplots_adjust(0.075, 0.14, 0.985, 0.97)
    touch_spans(axes, seconds, touching)
    smoothed = numpy.array([smooth(numpy.array(times[name])) for name in names])
    axes.stackplot(seconds, smoothed, linewidth=0,
                   labels=("T_L load", "T_R refine", "T_B refit", "T_Q query", "force"),
                   colors=(LOADED, TREE, PREDICTED, TOOL, FORCE))
    half = window_frames // 2  # There are fewer frames at the ends.
    axes.set(xlabel="time, s", ylabel="time of a frame, us",
             xlim=(seconds[half], seconds[-1 - half]),
             ylim=(0, 1.2 * smoothed.sum(axis=0)[half:-half].max()))
    axes.legend(frameon=False, ncol=5, loc="upper right")
    axes.grid(color="#dddddd", axis="y")
    axes.set_axisbelow(True)
    save(figure, path)


def bursts(studio, path):
    """Loaded pages for a hand that changes place twice a second, by capacity."""
    regimes = ((0.15, 1.5), (0.3, 1.5), (1.2, 3), (None, 16))
    figure, axes = pyplot.subplots(len(regimes), 1, figsize=(9.0, 1.3 * len(regimes) + 0.4),
                                   sharex=True)
    figure.subplots_adjust(0.075, 0.09, 0.985, 0.95, hspace=0.55)
    frames_a_bar = 50
    for one, (cache_mib, pool_mib) in zip(axes, regimes):
        words = [] if cache_mib is None else ["--no-static", "--cache-mib", cache_mib]
        take = studio.play(f"cache-{cache_mib}", studio.model(), "--pool-mib", pool_mib, *words,
                           "--tool", f"sphere:{RADIUS_M}", "--motion", "teleport", "--duration",
                           "1" if studio.quick else "10")
        came = take.column("pages_adopted")
        came = came[:len(came) // frames_a_bar * frames_a_bar]
        kinds = numpy.array([row["tool0.nearest.answer"] for row in take.rows()])
        seconds = numpy.arange(len(came)) * 1e-3
        touch_spans(one, seconds, take.column("tool0.in_contact")[:len(came)] > 0)
        one.bar(seconds[::frames_a_bar], came.reshape(-1, frames_a_bar).sum(axis=1),
                width=frames_a_bar * 1e-3, align="edge", color=LOADED, zorder=2)
        most = int(take.column("model0.pages_used").max())
        room = "all" if cache_mib is None else f"{most} pages"
        is_open = numpy.isin(kinds, ("bounded", "stale")).mean()
        one.set_title(f"capacity {room}: {int(came.sum()):,} pages loaded, "
                      f"{100 * is_open:.1f} % of the frames bounded or stale", fontsize=10, loc="left")
        one.grid(color="#dddddd", axis="y")
        one.set_ylabel("pages loaded")
    axes[-1].set(xlabel="time, s", xlim=(0, len(came) * 1e-3))
    save(figure, path)


def probe(studio, path):
    """Mesh tool: both surfaces are fine where they are near each other."""
    tool_model = studio.file("probe.spm", lambda to: run(
        studio.programs / "spm_build", "--shape", "bumpy-sphere", "--faces",
        2_000 if studio.quick else 10_000, "--fit-diag", 0.03, "-o", to))
    take = studio.play("probe", studio.model(), "--no-static", "--pool-mib", 8, "--tool",
                       f"mesh:{tool_model},0.0002", "--motion", "approach", "--duration", "2")
    film, frame = take.film(), take.pressing()
    state, object_, triangles, colours = shown(film, frame)
    tool = state["tools"][0]
    hash_ = studio.figures(tool_model)["hash"]
    other = film.cut(state, hash_)
    x, y, z, w = tool["proxy_rotation"]
    origin_m = numpy.array(studio.figures(tool_model)["bounds_m"]["low"])
    own = turned(other.triangles + origin_m,
                 {"rotation": (x, y, z, w), "scale": 1, "translation_m": tool["proxy_m"]})
    own_colours = ramp(other.levels / max(other.levels.max(), 1))
    centre = own.reshape(-1, 3).mean(axis=0)
    outward = centre / numpy.linalg.norm(centre)
    aside = numpy.cross(outward, (0.0, 0.0, 1.0))
    aside /= numpy.linalg.norm(aside)
    half = 0.62 * numpy.ptp(own.reshape(-1, 3), axis=0).max()
    figure, axes = pyplot.subplots(1, 3, figsize=(9.6, 3.4))
    figure.subplots_adjust(0.0, 0.0, 1.0, 0.91, wspace=0.01)
    side = Camera(aside + 0.25 * outward, up=outward)
    faces(axes[0], side, numpy.concatenate([triangles, own]),
          numpy.concatenate([colours, own_colours]), edge=0.3)
    radius_m = numpy.linalg.norm(triangles.reshape(-1, 3), axis=1).max()
    top = side.see(own.reshape(-1, 3))[:, 1].max()
    frame_axes(axes[0], (0, (top - radius_m) / 2), 1.04 * (top + radius_m) / 2)
    axes[0].set_title("model and tool", fontsize=11)
    for one, eye, some, shades, name in (
            (axes[1], outward, triangles, colours, f"the model below: {len(triangles):,} faces"),
            (axes[2], -outward, own, own_colours, f"the tool from below: {len(own):,} faces")):
        camera = Camera(eye)
        place = camera.see(centre)
        faces(one, camera, some, shades, edge=0.35, within=window(place, half))
        frame_axes(one, place, half)
        one.set_title(name, fontsize=11)
    save(figure, path)


PICTURES = {"touch.gif": touch, "cut.png": cut, "levels.png": levels, "tree.png": tree,
            "regions.png": regions, "bracket.png": bracket, "force.png": force, "scene.png": scene,
            "forest.png": forest, "chunks.png": chunks, "stages.png": stages, "bursts.png": bursts,
            "probe.png": probe}


def main():
    parser = argparse.ArgumentParser(add_help=False)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--scratch", type=pathlib.Path)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("names", nargs="*", metavar="NAME")
    try:
        asked = parser.parse_args()
    except SystemExit:
        sys.exit(3)
    names = asked.names or list(PICTURES)
    if unknown := [name for name in names if name not in PICTURES]:
        print(f"pictures: no picture {unknown[0]}; there are {', '.join(PICTURES)}")
        sys.exit(3)
    with tempfile.TemporaryDirectory() as scratch:
        folder = asked.scratch or pathlib.Path(scratch)
        studio = Studio(asked.programs.resolve(), folder.resolve(), asked.quick)
        try:
            for name in names:
                PICTURES[name](studio, asked.folder / name)
                print(f"{name} {(asked.folder / name).stat().st_size} bytes", flush=True)
        finally:
            studio.end()


main()
