# SPDX-License-Identifier: Apache-2.0
"""check_module.py MODULE_FOLDER SPM_BUILD SPM_INSPECT POSE_LOOP PAGE: the module `tactus` against
brute force over the whole mesh and against a loop in C++, and what it refuses. PAGE's programs
run."""
import os
import re
import subprocess
import sys
import tempfile
import time

try:
    import numpy as np
except ImportError:
    print("skipped: python3-numpy is missing (cmake/packages-test.txt)")
    sys.exit(77)

folder, spm_build, spm_inspect, pose_loop, page = (os.path.abspath(path) for path in sys.argv[1:6])
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
    """From a point to all triangles: to the plane where the foot is inside, else to the edges."""
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


def load_whole(frame, place):
    for _ in range(10_000):
        frame.load()
        frame.run(place)
        if frame.state()["is_whole"]:
            return
    expect(False, "the model was never here as a whole")


def check_distances(path, corners):
    """Every bracket holds the true distance; near the surface it is exact."""
    rng = np.random.default_rng(int(os.environ.get("TACTUS_SEED", "1")))
    places = rng.uniform(-0.09, 0.09, (300, 3)) * [1, 1, 0.4]
    truth = np.array([distance(place, corners) for place in places])
    frame = tactus.Frame([tactus.Model(path)], [tactus.Tool(0.02, passes_through=True)],
                         [tactus.Object()], memory_mib=8)
    answers = frame.run(places, rounds=1000)
    expect(answers.lower_m.shape == (300, 1) and answers.force_n.shape == (300, 3), "shapes")
    slack = 1e-7  # Corners of the file are single precision, in metres.
    expect(np.all(answers.lower_m[:, 0] <= truth + slack), "a lower bound is above the distance")
    expect(np.all(answers.upper_m[:, 0] >= truth - slack), "an upper bound is below the distance")
    near = truth < 0.02
    expect(near.sum() > 20, "no place is near the surface")
    kinds = answers.kind[near, 0]
    expect(np.all(kinds == tactus.EXACT), f"in reach, but of kind {kinds.max()}")
    off = np.linalg.norm(answers.nearest_m[near, 0] - places[near], axis=1) - truth[near]
    expect(np.max(np.abs(off)) < 1e-6, f"nearest points are off by {np.max(np.abs(off))}")
    # Two tools, two objects that stand apart, one moved: the same distances, farther by nothing.
    shift = np.array([0.3, 0.0, 0.0])
    two = tactus.Frame([tactus.Model(path)], [tactus.Tool(0.02, passes_through=True)] * 2,
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


def check_loop(path, scratch, count):
    """A call for many poses gives the bits of a loop in C++."""
    angle = np.linspace(0, 40 * np.pi, count)
    poses = np.stack([0.05 * np.cos(angle), 0.05 * np.sin(angle),
                      0.021 + 0.003 * np.sin(7.1 * angle)], axis=1)
    poses.tofile(os.path.join(scratch, "poses"))
    frame = tactus.Frame([tactus.Model(path)], [tactus.Tool(0.002)], [tactus.Object()],
                         memory_mib=32, loads_whole=True)
    load_whole(frame, poses[:1])
    out = os.path.join(scratch, "out")
    loop_s = float(subprocess.run([pose_loop, path, os.path.join(scratch, "poses"), "0.002", out],
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
    refuses(ValueError, "rotations: shape (3, 3)", lambda: frame.run(one, np.eye(3)))
    refuses(ValueError, "matrix 0 is not a rotation", lambda: frame.run(one, -np.eye(3)[None]))
    refuses(ValueError, "poses.rounds: 10001", lambda: frame.run(one, rounds=10_001))
    refuses(ValueError, "object: 1; 0 to 0", lambda: frame.place(1))
    refuses(ValueError, "pose.scale: 0", lambda: frame.place(0, scale=0))
    refuses(ValueError, "rotation: shape (3,)", lambda: frame.place(0, rotation=[1, 2, 3]))
    refuses(ValueError, "shape: 'cone'", lambda: tactus.Tool(0.1, shape="cone"))
    refuses(ValueError, "tools[0].radius_m: -1",
            lambda: tactus.Frame([tactus.Model(path)], [tactus.Tool(-1)], [tactus.Object()]))
    refuses(ValueError, "objects[0].model: 1; 0 to 0",
            lambda: tactus.Frame([tactus.Model(path)], [tactus.Tool(1)], [tactus.Object(1)]))
    refuses(ValueError, "setup.tool_count: 0", lambda: tactus.Frame([model], [], [tactus.Object()]))
    refuses(ValueError, "memory_mib", lambda: tactus.Frame([model], [], [], memory_mib=0))
    refuses(tactus.Error, "serves another frame",
            lambda: tactus.Frame([model], [tactus.Tool(0.01)], [tactus.Object()]))
    refuses(tactus.Error, "bytes; base meshes and a few pages",
            lambda: tactus.Frame([tactus.Model(path)], [tactus.Tool(0.01)], [tactus.Object()],
                                 memory_mib=0.1))
    refuses(tactus.Error, "nobody.spm", lambda: tactus.Model("nobody.spm"))
    refuses(ValueError, "domain: 233; 0 to 232", lambda: tactus.Model.find("ring", 233))
    refuses(ValueError, "name ''", lambda: tactus.Model.find(""))
    before = frame.run(one, rounds=100).lower_m
    expect(np.array_equal(frame.run(one).lower_m, before), "a refusal changed the frame")
    del frame  # The model is free again.
    tactus.Frame([model], [tactus.Tool(0.01)], [tactus.Object()])


def check_page(scratch):
    """Each program of the page runs, beside the model that it names."""
    with open(page, encoding="utf-8") as file:
        programs = re.findall(r"```python\n(.*?)```", file.read(), re.S)
    expect(len(programs) >= 2, "the page shows no programs")
    os.chdir(scratch)
    scope = {}
    for program in programs:
        exec(compile(program, page, "exec"), scope)  # One goes on where another ended.


def main():
    with tempfile.TemporaryDirectory() as scratch:
        path = os.path.join(scratch, "torus.spm")
        stl = os.path.join(scratch, "torus.stl")
        for line in ([spm_build, "--shape", "torus", "--faces", "20000", "-o", path],
                     [spm_inspect, path, "--extract", "--faces", "20000", "-o", stl]):
            subprocess.run(line, check=True, capture_output=True)
        corners = read_stl(stl)
        model = tactus.Model(path)
        expect(model.faces == len(corners) and model.is_closed, "faces of the model")
        expect(np.allclose(model.low_m, corners.min((0, 1)), atol=1e-6)
               and np.allclose(model.high_m, corners.max((0, 1)), atol=1e-6), "box of the model")
        expect(re.fullmatch("[0-9a-f]{32}", model.hash), "hash of the model")
        check_distances(path, corners)
        check_loop(path, scratch, int(os.environ.get("TACTUS_POSES", "100000")))
        check_refusals(path)
        check_page(scratch)
    sys.exit(1 if faults else 0)


main()
