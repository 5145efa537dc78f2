# SPDX-License-Identifier: Apache-2.0
"""check_module.py MODULE_FOLDER SPM_BUILD SPM_INSPECT SPM_PUBLISH POSE_LOOP PAGE: the module
`tactus` compared with brute force over the whole mesh and with a loop in C++, from a file and from
a server, and its refusals. PAGE's programs run, those for a shell first."""
import ast
import doctest
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import tracemalloc
import warnings

try:
    import numpy as np
except ImportError:
    print("skipped: python3-numpy is missing (cmake/packages-test.txt)")
    sys.exit(77)

folder, spm_build, spm_inspect, spm_publish, pose_loop, page = (
    os.path.abspath(path) for path in sys.argv[1:7])
DOMAIN = int(os.environ.get("TACTUS_TEST_DOMAIN", os.getpid() % 231))
PATIENCE_S = 150
sys.path.insert(0, folder)
import tactus  # noqa: E402

faults = 0


def expect(holds, text):
    global faults
    if not holds:
        faults += 1
        print("FAULT:", text)


def refuses(kind, words, call):
    try:
        call()
    except kind as error:
        expect(words in str(error) and "\n" not in str(error), f"'{error}' is not '{words}'")
    else:
        expect(False, f"not refused: '{words}'")


def read_stl(path):
    """Corners of all triangles of a binary STL, F x 3 x 3."""
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    return np.fromfile(path, record, offset=84)["corners"].astype(float)


def distance(place, corners):
    """Distance from a point to all triangles: to the plane if the foot is inside, otherwise to the
    edges."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    normal = np.cross(b - a, c - a)
    height = np.einsum("ij,ij->i", place - a, normal) / np.einsum("ij,ij->i", normal, normal)
    foot = place - height[:, None] * normal
    inside = np.ones(len(a), bool)
    best = np.full(len(a), np.inf)
    for p, q in ((a, b), (b, c), (c, a)):
        inside &= np.einsum("ij,ij->i", np.cross(q - p, foot - p), normal) >= 0
        way = q - p
        t = np.clip(np.einsum("ij,ij->i", place - p, way) / np.einsum("ij,ij->i", way, way), 0, 1)
        best = np.minimum(best, np.linalg.norm(place - p - t[:, None] * way, axis=1))
    flat = np.abs(height) * np.linalg.norm(normal, axis=1)
    return np.min(np.where(inside, np.minimum(flat, best), best))


def load_whole(frame, place, turn=None):
    for _ in range(10_000):
        frame.load()
        frame.run(place, turn)
        if frame.state()["is_whole"]:
            return
    expect(False, "the model was never here as a whole")


def check_distances(path, corners):
    """All bounds hold the true distance; near the surface they are exact."""
    rng = np.random.default_rng(int(os.environ.get("TACTUS_SEED", "1")))
    places = rng.uniform(-0.09, 0.09, (300, 3)) * [1, 1, 0.4]
    truth = np.array([distance(place, corners) for place in places])
    frame = tactus.Frame([tactus.Model(path)], [tactus.Tool(0.02, query_only=True)],
                         [tactus.Object()], memory_mib=8)
    answers = frame.run(places, rounds=1000)
    expect(answers.lower_m.shape == (300, 1) and answers.force_n.shape == (300, 3), "shapes")
    slack = 1e-7  # The file's corners are in single precision, in metres.
    expect(np.all(answers.lower_m[:, 0] <= truth + slack), "a lower bound is above the distance")
    expect(np.all(answers.upper_m[:, 0] >= truth - slack), "an upper bound is below the distance")
    near = truth < 0.02
    expect(near.sum() > 20, "no place is near the surface")
    kinds = answers.kind[near, 0]
    expect(np.all(kinds == tactus.EXACT), f"in reach, but of kind {kinds.max()}")
    off = np.linalg.norm(answers.nearest_m[near, 0] - places[near], axis=1) - truth[near]
    expect(np.max(np.abs(off)) < 1e-6, f"nearest points are off by {np.max(np.abs(off))}")
    # A small tool that requests it has the distance from anywhere, another only in reach.
    for wants in (True, False):
        small = tactus.Frame([tactus.Model(path)],
                             [tactus.Tool(0.001, query_only=True, wants_distance=wants)],
                             [tactus.Object()], memory_mib=8)
        answers = small.run(places[:60] * 3, rounds=3000)
        exact = answers.kind[:, 0] == tactus.EXACT
        expect(np.all(exact) if wants else exact.sum() < 30, f"{exact.sum()} exact of wants {wants}")
        far = np.array([distance(place, corners) for place in places[:60] * 3])
        off = np.abs(answers.lower_m[exact, 0] - far[exact])
        expect(np.max(off, initial=0) < 1e-6, f"distances from afar are off by {np.max(off, initial=0)}")
    # Two tools, two separate objects, one displaced: the distances are the same.
    shift = np.array([0.3, 0.0, 0.0])
    two = tactus.Frame([tactus.Model(path)], [tactus.Tool(0.02, query_only=True)] * 2,
                       [tactus.Object(), tactus.Object(translation_m=shift)], memory_mib=8)
    both = np.stack([places[near], places[near] + shift], axis=1)
    answers = two.run(both, rounds=1000)
    expect(answers.lower_m.shape == (near.sum(), 2, 2), "shapes of two tools and two objects")
    for i in range(2):
        expect(np.max(np.abs(answers.lower_m[:, i, i] - truth[near])) < 1e-6, f"of object {i}")
        far = answers.lower_m[:, i, 1 - i]
        expect(np.all((far > 0.02) & (far <= 0.3)), f"of what is far from {i}: {far.min()}")
    two.place(1, translation_m=2 * shift)
    moved = two.run(both + [[[0, 0, 0], shift]], rounds=1000)
    expect(np.max(np.abs(moved.lower_m[:, 1, 1] - truth[near])) < 1e-6, "of an object that moved")


def check_static(path, corners):
    """Any point at any distance; sides of a torus by its equation, away from its facets."""
    rng = np.random.default_rng(7)
    model = tactus.StaticModel(path)
    low, high = corners.min((0, 1)), corners.max((0, 1))
    places = np.vstack([rng.uniform(low, high, (300, 3)), 100 * rng.uniform(low, high, (20, 3))])
    answer = model.distances(places)
    truth = np.array([distance(place, corners).min() for place in places])
    slack = 1e-6 * np.linalg.norm(high - low)  # Error of the STL's 32-bit corners.
    expect(np.all(np.abs(answer.lower_m - truth) < slack)
           and np.all(answer.upper_m - answer.lower_m < 1e-12), "distances of the whole model")
    expect(np.allclose(np.linalg.norm(places - answer.nearest_m, axis=1), truth, atol=slack),
           "nearest points of the whole model")
    expect(set(answer.side) == {tactus.OUTSIDE, tactus.INSIDE}
           and np.all(answer.side[300:] == tactus.OUTSIDE), "sides of the whole model")
    expect(len(model.distances(np.zeros((0, 3))).lower_m) == 0, "no points, no answers")
    refuses(ValueError, "points_m: shape (3,); (3, 3) is needed", lambda: model.distances([1, 2, 3]))
    refuses(ValueError, "points_m: point 1 (0 nan 0): not within",
            lambda: model.distances([[0, 0, 0], [0, np.nan, 0]]))
    refuses(TypeError, "points_m", lambda: model.distances("here"))
    refuses(tactus.Error, "nobody.spm", lambda: tactus.StaticModel("nobody.spm"))


def check_loop(path, scratch, count):
    """A call for many poses has the bits of a loop in C++."""
    angle = np.linspace(0, 40 * np.pi, count)
    poses = np.stack([0.05 * np.cos(angle), 0.05 * np.sin(angle),
                      0.021 + 0.003 * np.sin(7.1 * angle)], axis=1)
    poses.tofile(os.path.join(scratch, "poses"))
    frame = tactus.Frame([tactus.Model(path)], [tactus.Tool(0.002)], [tactus.Object()],
                         memory_mib=32, loads_whole=True)
    load_whole(frame, poses[:1])
    out = os.path.join(scratch, "out")
    loop_s = float(subprocess.run(
        [pose_loop, path, os.path.join(scratch, "poses"), "0.002", out],
        check=True, capture_output=True, text=True).stdout)
    begin = time.thread_time()
    answers = frame.run(poses)
    call_s = time.thread_time() - begin
    loop = np.fromfile(out).reshape(count, 5)
    expect(np.array_equal(answers.force_n, loop[:, :3]), "forces differ from those of a C++ loop")
    expect(np.array_equal(answers.lower_m[:, 0], loop[:, 3]), "lower bounds differ")
    expect(np.array_equal(answers.upper_m[:, 0], loop[:, 4]), "upper bounds differ")
    touched = (answers.flags & tactus.IN_CONTACT) != 0
    expect(0 < touched.sum() < count, "a hand that dips in and out is always or never in touch")
    expect(np.all(np.linalg.norm(answers.force_n[~touched], axis=1) == 0), "a force without touch")
    print(f"{count} poses: {call_s:.3f} s in one call, {loop_s:.3f} s in a loop of C++,"
          f" ratio {call_s / loop_s:.2f}")
    few, many = python_work(frame, poses[:10]), python_work(frame, poses)
    expect(few == many, f"Python's calls and bytes: {few} of 10 poses, {many} of {count}")


def python_work(frame, poses):
    """Cost of a call in Python: entries into its functions and C's, bytes without the arrays."""
    calls = []
    sys.setprofile(lambda scope, event, function: calls.append(event))
    frame.run(poses)
    sys.setprofile(None)
    tracemalloc.start()
    answers = frame.run(poses)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    arrays = [getattr(answers, name) for name in dir(answers) if not name.startswith("_")]
    return len(calls), (most - sum(array.nbytes for array in arrays)) // 65_536


def samples(shape, half):
    """Points of a tool's core, and the greatest distance of any other point from one of them."""
    if shape == "capsule":
        return np.linspace(-1, 1, 201)[:, None] * half, np.linalg.norm(half) / 200
    steps = np.linspace(-1, 1, 13)
    points = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)
    return points[np.max(np.abs(points), axis=1) == 1] * half, np.linalg.norm(half) / 12


def check_shapes(path, corners):
    """Rotated capsule and box: exact distances are those of points of their cores."""
    rng = np.random.default_rng(int(os.environ.get("TACTUS_SEED", "1")))
    for shape, half in (("capsule", np.array([0.0, 0.004, 0.01])),
                        ("box", np.array([0.002, 0.004, 0.006]))):
        core, gap = samples(shape, half)
        frame = tactus.Frame(
            [tactus.Model(path)],
            [tactus.Tool(0.02, shape=shape, half_m=half, query_only=True)],
            [tactus.Object()], memory_mib=8)
        around = rng.uniform(0, 2 * np.pi, 6)
        places = np.stack([0.05 * np.cos(around), 0.05 * np.sin(around),
                           rng.uniform(0.034, 0.042, 6)], axis=1)
        turns = np.linalg.qr(rng.normal(size=(6, 3, 3)))[0]
        turns *= np.linalg.det(turns)[:, None, None]
        answers = frame.run(places, turns, rounds=1000)
        for i, (place, turn) in enumerate(zip(places, turns)):
            near = corners[np.linalg.norm(corners.mean(axis=1) - place, axis=1) < 0.05]
            truth = min(distance(place + turn @ point, near) for point in core)
            kind, lower, upper = (value[i, 0] for value in
                                  (answers.kind, answers.lower_m, answers.upper_m))
            expect(kind == tactus.EXACT and upper - lower < 1e-9, f"{shape} {i}: of kind {kind}")
            expect(truth - gap - 1e-7 <= lower <= truth + 1e-7,
                   f"{shape} {i}: {lower} m, by its points {truth - gap} to {truth}")


def check_torque(path):
    """A capsule pressed on with one end has a torque about its centre, by the lever."""
    half = 0.02
    frame = tactus.Frame([tactus.Model(path)],
                         [tactus.Tool(0.002, shape="capsule", half_m=[half, 0, 0])],
                         [tactus.Object()], memory_mib=32, loads_whole=True)
    top = np.array([0.0, 0.05 - half, 0.0])  # One end along y is over the top of the ring.
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    load_whole(frame, top + [[0, 0, 0.03]], turn[None])
    height = np.linspace(0.03, 0.0205, 2000)
    answers = frame.run(top + height[:, None] * [0.0, 0.0, 1.0], np.tile(turn, (2000, 1, 1)))
    force, torque = answers.force_n[-1], answers.torque_nm[-1]
    expect(force[2] > 0.3, f"no force upwards: {force}")
    lever = torque[0] / force[2]  # (0, y, 0) x (0, 0, F) = (y F, 0, 0).
    expect(0.5 * half < lever < 1.2 * half, f"torque {torque} of force {force}")
    free = answers.flags & tactus.IN_CONTACT == 0
    expect(free[0] and np.all(answers.torque_nm[free] == 0), "a torque without touch")


def check_feel(path):
    """A hand that presses a surface gets the new material's force, without a step."""
    frame = tactus.Frame([tactus.Model(path)], [tactus.Tool(0.002, stiffness_n_per_m=500)],
                         [tactus.Object()], memory_mib=32, loads_whole=True)
    load_whole(frame, [[0.05, 0, 0.03]])
    down = np.stack([np.full(200, 0.05), np.zeros(200), np.linspace(0.03, 0.021, 200)], axis=1)
    hard = np.linalg.norm(frame.run(np.vstack([down, down[-1:]])).force_n[-1])
    frame.feel(0, stiffness_n_per_m=250, static_friction=0.5, dynamic_friction=0.5)
    softer = np.linalg.norm(frame.run(np.repeat(down[-1:], 60, axis=0)).force_n, axis=1)
    expect(hard > 0.1 and abs(softer[-1] - hard / 2) < 1e-3 * hard, "not half as stiff")
    expect(np.all(np.abs(np.diff(softer)) < hard / 50), "a step where it becomes softer")
    aside = frame.run(down[-1:] + [[0, 1e-4, 0]]).force_n[-1]
    expect(aside[1] < -0.02, "it doesn't stick where it has become rough")
    frame.feel(0)
    aside = frame.run(np.repeat(down[-1:] + [[0, 1e-4, 0]], 60, axis=0)).force_n[-1]
    expect(abs(np.linalg.norm(aside) - hard) < 1e-2 * hard and abs(aside[1]) < 0.01 * hard,
           "it isn't as it was")


def forces_when_shaken(path, speed_m_per_s):
    """Forces on a hand 3 mm deep, under which the object moves up and down by 2 mm every four
    frames."""
    frame = tactus.Frame([tactus.Model(path)], [tactus.Tool(0.002, stiffness_n_per_m=500)],
                         [tactus.Object()], memory_mib=32, loads_whole=True,
                         object_speed_max_m_per_s=speed_m_per_s)
    load_whole(frame, [[0.05, 0, 0.03]])
    down = np.stack([np.full(200, 0.05), np.zeros(200), np.linspace(0.03, 0.019, 200)], axis=1)
    forces, flags = [frame.run(down).force_n[-1]], []
    for i in range(200):
        frame.place(0, translation_m=[0, 0, 0.002 if i // 4 % 2 == 0 else -0.002])
        answers = frame.run(down[-1:])
        forces.append(answers.force_n[0])
        flags.append(answers.flags[0])
    return np.linalg.norm(np.diff(forces, axis=0), axis=1).max(), np.array(flags)


def check_carried(path, corners):
    """A touched object moves at most at its speed limit, and reaches its target."""
    believed, flags = forces_when_shaken(path, 1e6)
    expect(believed > 1.5 and not np.any(flags & tactus.RATE_LIMITED), f"a step of {believed} N")
    held, flags = forces_when_shaken(path, 0.5)
    expect(held <= 1.3 * 500 * 0.5 * 1e-3, f"a step of {held} N at 0.5 m/s")
    expect(not np.any(flags & tactus.RATE_LIMITED), "4 mm are no 20 ms of 0.5 m/s")
    # Hand 1 mm deep, and a probe above it that measures the height of the ring's top.
    probe = tactus.Tool(0.001, query_only=True, wants_distance=True)
    frame = tactus.Frame([tactus.Model(path)], [tactus.Tool(0.002), probe], [tactus.Object()],
                         memory_mib=32, loads_whole=True)

    stands_m = distance(np.array([0.05, 0, 0.2]), corners)

    def run(heights):
        places = [[[0.05, 0, height], [0.05, 0, 0.2]] for height in heights]
        answers = frame.run(places)
        expect(np.all(answers.kind[:, 1] == tactus.EXACT), "a height that isn't exact")
        return stands_m - answers.lower_m[:, 1, 0], answers.flags[:, 0]

    load_whole(frame, [[[0.05, 0, 0.03], [0.05, 0, 0.2]]])
    _, flags = run(np.linspace(0.03, 0.021, 200))
    expect(flags[-1] & tactus.IN_CONTACT, "no touch")
    frame.place(0, translation_m=[0, 0, 0.012])
    height, flags = run(np.full(60, 0.021))
    outrun = flags & tactus.RATE_LIMITED != 0
    expect(np.any(outrun[:8]) and not np.any(outrun[8:]), f"rate-limited in {np.flatnonzero(outrun)}")
    rise = np.diff(np.concatenate([[0], height]))
    expect(np.all(rise < 0.501e-3), f"carried by {rise.max()} m in a frame")
    expect(abs(height[-1] - 0.012) < 1e-5, f"it is at {height[-1]} m, not where it was put")
    run(np.linspace(0.021, 1.0, 300))
    for where in (-0.5, 0.0, -0.2):  # An object beyond reach within 20 ms moves at once.
        frame.place(0, translation_m=[0, 0, 1])  # The last place of an object counts.
        frame.place(0, translation_m=[0, 0, where])
        height, _ = run([1.0])
        expect(abs(height[0] - where) < 1e-5, f"it is at {height[0]} m, not at once at {where}")
    many = tactus.Frame([tactus.Model(path)], [tactus.Tool(0.01)], [tactus.Object()] * 65,
                        memory_mib=32)
    for i in [*range(64), 63, 0]:  # The last place of an object counts.
        many.place(i)
    refuses(tactus.Error, "64 changes of objects are pending; run a frame first",
            lambda: many.place(64))
    many.run([[0, 0, 1]])
    many.place(64)


def check_server(path):
    """A model from a server has the same answers as its file."""
    server = subprocess.Popen([spm_publish, "--domain", str(DOMAIN), path],
                            stdout=subprocess.DEVNULL)
    try:
        model = tactus.Model.find("torus", domain=DOMAIN, wait_s=PATIENCE_S)
        expect(model.hash == tactus.Model(path).hash and model.faces == 5000, "another model")
        pinned = tactus.Model.find(f"torus@{model.hash}", DOMAIN, PATIENCE_S)
        expect(pinned.hash == model.hash, "another model by its hash")
        frame = tactus.Frame([model], [tactus.Tool(0.02, query_only=True)],
                             [tactus.Object()], memory_mib=8)
        places = np.array([[0.05, 0, 0.03], [0, 0.05, 0.025]])
        end = time.monotonic() + PATIENCE_S
        answers = frame.run(places)
        while np.any(answers.kind != tactus.EXACT) and time.monotonic() < end:
            frame.load()  # The requested data are in transit.
            answers = frame.run(places)
        same = tactus.Frame([tactus.Model(path)], [tactus.Tool(0.02, query_only=True)],
                            [tactus.Object()], memory_mib=8).run(places, rounds=1000)
        expect(np.all(answers.kind == tactus.EXACT), "never exact")
        expect(np.array_equal(answers.lower_m, same.lower_m), "other distances than the file's")
    finally:
        server.kill()
        server.wait()



def check_begins_inside(path):
    """A tool in the tube of the torus is warned of, once; one in its hole is not, nor a query-only
    one."""
    def warned(place, **tool):
        frame = tactus.Frame([tactus.Model(path)], [tactus.Tool(0.001, **tool)], [tactus.Object()])
        with warnings.catch_warnings(record=True) as seen:
            warnings.simplefilter("always")
            for _ in range(2):
                frame.run([place])
        return [str(warning.message) for warning in seen]

    words = ["tool 0 begins inside a closed object, whose surface keeps it inside"]
    expect(warned([0.05, 0, 0]) == words, "no warning of a tool inside")
    expect(warned([0, 0, 0]) == [], "a warning of a tool in the hole")
    expect(warned([0.05, 0, 0], query_only=True) == [], "a warning of a tool that passes through")


def check_refusals(path):
    model = tactus.Model(path)
    frame = tactus.Frame([model], [tactus.Tool(0.01)], [tactus.Object()])
    one = np.zeros((1, 3))
    refuses(ValueError, "positions_m: shape (1, 2); (1, 3) is needed",
            lambda: frame.run(one[:, :2]))
    refuses(ValueError, "positions_m: shape (3,)", lambda: frame.run(one[0]))
    refuses(TypeError, "positions_m: complex128", lambda: frame.run(one + 1j))
    refuses(TypeError, "positions_m", lambda: frame.run("here"))
    refuses(TypeError, "positions_m", lambda: frame.run(None))
    refuses(ValueError, "element 2 is nan", lambda: frame.run([[0, 0, np.nan]]))
    refuses(ValueError, "element 0 is inf", lambda: frame.run([[np.inf, 0, 0]]))
    refuses(ValueError, "element 1 is -1000000; its magnitude must be below 1000000 m",
            lambda: frame.run([[0, -1e6, 0]]))
    refuses(ValueError, "pose.translation_m: 20000; -10000 to 10000",
            lambda: frame.place(0, translation_m=[0, 2e4, 0]))
    refuses(ValueError, "rotations: shape (3, 3)", lambda: frame.run(one, np.eye(3)))
    refuses(ValueError, "matrix 0 is not a rotation", lambda: frame.run(one, -np.eye(3)[None]))
    refuses(ValueError, "poses.rounds: 10001", lambda: frame.run(one, rounds=10_001))
    refuses(ValueError, "object: 1; 0 to 0", lambda: frame.place(1))
    refuses(ValueError, "pose.scale: 0", lambda: frame.place(0, scale=0))
    for name, value, allowed in (("stiffness_n_per_m", -1, "0.001 to 1000000"),
                                 ("static_friction", np.nan, "0 to 3"),
                                 ("dynamic_friction", 0.1, "0 to 0"),
                                 ("damping_n_s_per_m", 21, "0 to 20"),
                                 ("viscosity_n_s_per_m", -1, "0 to 20"),
                                 ("texture_length_m", 2, "0 to 1"),
                                 ("texture_height_m", -1, "0 to 0")):
        refuses(ValueError, f"material.{name}: {value}; {allowed}",
                lambda name=name, value=value: frame.feel(0, **{name: value}))
    refuses(ValueError, "material.texture_height_m: 0.1; 0 to 0.03125",
            lambda: frame.feel(0, texture_height_m=0.1, texture_length_m=1))
    refuses(ValueError, "object: 1; 0 to 0", lambda: frame.feel(1))
    refuses(ValueError, "rotation: shape (3,)", lambda: frame.place(0, rotation=[1, 2, 3]))
    refuses(ValueError, "shape: 'cone'", lambda: tactus.Tool(0.1, shape="cone"))
    refuses(ValueError, "tools[0].radius_m: -1",
            lambda: tactus.Frame([tactus.Model(path)], [tactus.Tool(-1)], [tactus.Object()]))
    refuses(ValueError, "tools[0].radius_m: 2; 1e-06 to 1 is allowed",  # The limits of hrtc --tool.
            lambda: tactus.Frame([tactus.Model(path)], [tactus.Tool(2)], [tactus.Object()]))
    tactus.Frame([tactus.Model(path)], [tactus.Tool(2, query_only=True)], [tactus.Object()])
    refuses(ValueError, "tools[0].shading_m: 1; 0.0001 to 0.1",
            lambda: tactus.Frame([tactus.Model(path)], [tactus.Tool(1, shading_m=1)],
                                 [tactus.Object()]))
    refuses(ValueError, "tools[0].shading_m: 0.01; only a sphere has force shading",
            lambda: tactus.Frame([tactus.Model(path)],
                                 [tactus.Tool(1, shape="box", half_m=[1, 1, 1], shading_m=0.01)],
                                 [tactus.Object()]))
    refuses(ValueError, "objects[0].model: 1; 0 to 0",
            lambda: tactus.Frame([tactus.Model(path)], [tactus.Tool(1)], [tactus.Object(1)]))
    refuses(ValueError, "setup.tool_count: 0", lambda: tactus.Frame([model], [], [tactus.Object()]))
    refuses(ValueError, "memory_mib", lambda: tactus.Frame([model], [], [], memory_mib=0))
    refuses(tactus.Error, "is in another frame",
            lambda: tactus.Frame([model], [tactus.Tool(0.01)], [tactus.Object()]))
    refuses(tactus.Error, "memory: 104857 bytes; the models need ",
            lambda: tactus.Frame([tactus.Model(path)], [tactus.Tool(0.01)], [tactus.Object()],
                                 memory_mib=0.1))
    refuses(tactus.Error, "nobody.spm", lambda: tactus.Model("nobody.spm"))
    refuses(ValueError, "domain: 233; 0 to 232", lambda: tactus.Model.find("ring", 233))
    refuses(ValueError, "name ''", lambda: tactus.Model.find(""))
    before = frame.run(one, rounds=100).lower_m
    expect(np.array_equal(frame.run(one).lower_m, before), "a refusal changed the frame")
    del frame  # The model is free again.
    tactus.Frame([model], [tactus.Tool(0.01)], [tactus.Object()])


def arguments_of(function):
    """(name, default) of each argument in the stub, None without a default."""
    plain = function.args.args
    defaults = [None] * (len(plain) - len(function.args.defaults)) + function.args.defaults
    both = [*zip(plain, defaults), *zip(function.args.kwonlyargs, function.args.kw_defaults)]
    return [(argument.arg, None if default is None else ast.literal_eval(default))
            for argument, default in both]


def arguments_in(signature):
    """The same from the module's own line."""
    found = []
    for name, default in re.findall(r"(\w+): [^=,()]*(?:\[[^=]*\])?(?: = ([^,)]+))?[,)]", signature):
        found.append((name, None if default == "" else ast.literal_eval(default)))
    return found


def check_documentation(scratch):
    """The examples of the docstrings run; the stub has the module's content and arguments."""
    os.chdir(scratch)
    result = doctest.testmod(tactus, extraglobs={"tactus": tactus})
    expect(result.failed == 0 and result.attempted >= 12, f"docstrings: {result}")
    with open(os.path.join(folder, "tactus.pyi"), encoding="utf-8") as file:
        stub = ast.parse(file.read())
    classes = {each.name: each for each in stub.body if isinstance(each, ast.ClassDef)}
    names = {each.target.id for each in stub.body if isinstance(each, ast.AnnAssign)} | set(classes)
    functions = {each.name: each for each in stub.body if isinstance(each, ast.FunctionDef)}
    names |= set(functions)
    shown = {name for name in dir(tactus) if not name.startswith("_")} | {"__version__"}
    records = {"FrameState", "WorldCounts"}
    expect(names - records == shown, f"the stub's names differ: {names ^ shown}")
    for name, node in functions.items():
        signature = getattr(tactus, name).__doc__.splitlines()[0]
        expect(arguments_of(node) == arguments_in(signature), f"{name} is not {signature}")
    fields = {each.target.id for each in classes["WorldCounts"].body}
    expect(fields == set(tactus.World().counts()), "the stub's WorldCounts differs")
    fields = {each.target.id for each in classes["FrameState"].body}
    frame = tactus.Frame([tactus.Model("torus.spm")], [tactus.Tool(0.01)], [tactus.Object()])
    expect(fields == set(frame.state()), "the stub's FrameState differs")
    for name, told in classes.items():
        if name in records | {"Error"}:
            continue
        kind = getattr(tactus, name)
        methods = {each.name: each for each in told.body}
        has = {each for each in vars(kind) if not each.startswith("_")}
        expect(set(methods) - {"__init__"} == has, f"{name} differs: {set(methods) ^ has}")
        for method, node in methods.items():
            if not isinstance(vars(kind)[method], property):
                signature = getattr(kind, method).__doc__.splitlines()[0]
                expect(arguments_of(node) == arguments_in(signature),
                       f"{name}.{method}: {arguments_of(node)} is not {signature}")


def check_worlds(scratch):
    """A World's refusals, and a mesh in memory that feels as its file does."""
    os.chdir(scratch)
    path = np.linspace([0.05, 0, 0.0315], [0.05, 0, 0.0215], 500)
    refuses(tactus.Error, "nowhere.spm: ", lambda: tactus.touch("nowhere.spm", path))
    refuses(ValueError, "positions_m: shape (3,); (3, 3) is needed",
            lambda: tactus.touch("torus.spm", path[0]))
    refuses(ValueError, "vertices: shape (2,)", lambda: tactus.touch(([0, 1], [[0, 1, 2]]), path))
    triangle = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    for corner in (-1, 0.5, float("nan"), 2.0**32):
        refuses(ValueError, "faces: element 2 is ",
                lambda: tactus.touch((triangle, [[0, 1, corner]]), path))
    refuses(TypeError, "model: <class 'int'>; a path, or a pair", lambda: tactus.touch(7, path))
    refuses(tactus.Error, "tool: 'ball:1'", lambda: tactus.World().hand("ball:1"))
    refuses(tactus.Error, "the World has no hand", lambda: tactus.World().start())
    world = tactus.World(objects_max=1)
    refuses(tactus.Error, "nowhere.spm: ", lambda: world.add("nowhere.spm"))
    refuses(tactus.Error, "tool: 'ball:1'", lambda: world.hand("ball:1"))
    part = world.add("torus.spm")
    hand = world.hand()
    refuses(ValueError, "rotation: shape (2, 2)",
            lambda: hand.step(path[0], rotation=np.zeros((2, 2))))
    refuses(ValueError, "rotation: not a rotation", lambda: hand.step(path[0], np.zeros((3, 3))))
    refuses(ValueError, "position_m: (nan, 0, 0)", lambda: hand.step([float("nan"), 0, 0]))
    refuses(ValueError, "dt_s: -1; 0 or more", lambda: hand.step(path[0], dt_s=-1))
    felt = hand.path(path)
    expect(felt.force_n.shape == (500, 3) and felt.in_contact[-1], "a path does not touch")
    expect(np.array_equal(tactus.touch(pathlib.Path("torus.spm"), path).force_n, felt.force_n),
           "touch() feels something else")
    expect(hand.state().force_n == list(felt.force_n[-1]), "the state is another")
    part.remove()
    refuses(tactus.Error, "was removed before", part.remove)
    world.stop()
    refuses(tactus.Error, "the World has ended", lambda: hand.step(path[0]))


def check_edits(scratch):
    """Edits of a World's model have the volumes of solids, are felt and saved, or refused."""
    os.chdir(scratch)
    corners = np.array([[0, 0, 0], [10, 0, 0], [0, 10, 0], [0, 0, 10]])  # In mm.
    faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    far = [0, 0, 1]
    below = [0.0025, 0.0025, -0.002]
    world = tactus.World()
    part = world.add((corners, faces), unit="mm", edit_faces=4096)
    stiff = world.add((corners, faces), unit="mm", translation_m=far)
    hand = world.hand("sphere:0.001", edit="carve:5000")
    box = "box:0.002,0.002,0.002"
    refuses(tactus.Error, "carve(): edits begin with the first frame",
            lambda: part.carve(box, [0, 0, 0], [0, 0, 0]))
    hand.step(below)
    rounding = 5e-12  # m^3, of the grid and the shift of a swept tool.
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    carved = part.carve(box, [0, 0, 0], [0, 0, 0], turn)
    expect(abs(carved - 1e-9) < rounding, f"an eighth of the box is carved, {carved}")
    within_m = [0.0008, 0.0008, 0.0008]
    filled = part.fill("box:0.001,0.001,0.001", within_m, to_m=within_m)
    expect(abs(filled - 0.343e-9) < rounding, f"a part of it is filled, {filled}")
    moved = part.displace([0, 0, 0.01], 0.002, [0, 0, -0.001])
    expect(abs(moved + 1e-7 / 6) < rounding, f"a tenth of the solid is pressed in, {moved}")
    into = np.linspace(below, [0.0025, 0.0025, 0.001], 3000)
    depth = hand.path(into).proxy_m[-1, 2] + 0.001
    expect(depth > 3e-4, f"a burr is {depth} m deep in the bottom")
    part.save(pathlib.Path("carved.spm"))
    volume = tactus.StaticModel("carved.spm")
    expect(volume.distances([[0.0025, 0.0025, 1e-4]]).side[0] == tactus.OUTSIDE,
           "a saved model has no hole")
    refuses(tactus.Error, "has no room for edits; set edit_faces",
            lambda: stiff.fill(box, [0, 0, 0], [0, 0, 0]))
    refuses(tactus.Error, "carve(): tool: only a sphere",
            lambda: part.carve("point", [0, 0, 0], [0, 0, 0]))
    refuses(ValueError, "to_m: shape (2,); (3,) is needed", lambda: part.carve(box, far, [0, 0]))
    refuses(ValueError, "to_m: element 0 is nan", lambda: part.carve(box, far, [np.nan, 0, 0]))
    refuses(ValueError, "position_m: (nan, 0, 0)", lambda: part.fill(box, [np.nan, 0, 0], far))
    refuses(ValueError, "radius_m: element 0 is nan",
            lambda: part.displace(far, np.nan, [0, 0, 1]))
    refuses(tactus.Error, "displace(): displacement: ", lambda: part.displace(far, -1, far))
    refuses(tactus.Error, "/nowhere/", lambda: part.save("/nowhere/carved.spm"))
    refuses(TypeError, "int", lambda: part.save(7))
    refuses(ValueError, "object.edit_faces: 300000; 0 to 262144",
            lambda: tactus.World().add("torus.spm", edit_faces=300_000))
    refuses(tactus.Error, "edit_faces: 1; 0 to 0 is allowed for a published model",
            lambda: tactus.World().add("torus", published=True, edit_faces=1))
    refuses(tactus.Error, "edit: 'carve:0'", lambda: tactus.World().hand(edit="carve:0"))
    world.stop()
    part.save("again.spm")
    expect(tactus.Model("again.spm").hash == tactus.Model("carved.spm").hash,
           "a World that has ended saves another model")


def check_page(scratch):
    """Each program of the page runs; the shell's make the model that the others name."""
    with open(page, encoding="utf-8") as file:
        programs = re.findall(r"```(python|sh)\n(.*?)```", file.read(), re.S)
    expect({language for language, _ in programs} == {"python", "sh"} and len(programs) >= 3,
           "the page shows no programs")
    os.chdir(scratch)
    os.remove("torus.spm")
    tools = os.environ | {"PATH": os.path.dirname(spm_build) + os.pathsep + os.environ["PATH"]}
    scope = {}
    for language, program in programs:
        if language == "sh":
            subprocess.run(["bash", "-euc", program], check=True, env=tools, capture_output=True)
        else:
            # Each continues where the previous one ended.
            exec(compile(program, page, "exec"), scope)


def main():
    sys.stdout.reconfigure(line_buffering=True)
    with tempfile.TemporaryDirectory() as scratch:
        path = os.path.join(scratch, "torus.spm")
        stl = os.path.join(scratch, "torus.stl")
        for line in ([spm_build, "--shape", "torus", "--faces", "5000", "-o", path],
                     [spm_inspect, path, "--extract", "--faces", "5000", "-o", stl]):
            subprocess.run(line, check=True, capture_output=True)
        corners = read_stl(stl)
        model = tactus.Model(path)
        expect(model.faces == len(corners) and model.is_closed, "faces of the model")
        expect(np.allclose(model.low_m, corners.min((0, 1)), atol=1e-6)
               and np.allclose(model.high_m, corners.max((0, 1)), atol=1e-6), "box of the model")
        expect(re.fullmatch("[0-9a-f]{32}", model.hash), "hash of the model")
        check_distances(path, corners)
        check_static(path, corners)
        check_loop(path, scratch, int(os.environ.get("TACTUS_POSES", "100000")))
        check_shapes(path, corners)
        check_torque(path)
        check_feel(path)
        check_carried(path, corners)
        check_server(path)
        check_begins_inside(path)
        check_worlds(scratch)
        check_edits(scratch)
        check_refusals(path)
        check_documentation(scratch)
        check_page(scratch)
    sys.exit(1 if faults else 0)


main()
