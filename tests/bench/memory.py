#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""Measures what pools of a size are good for: the suite `memory` of docs/benchmarks.

    memory.py PROGRAMS MODELS FILE [--quick]

PROGRAMS is the folder with hrtc, spm_build and spm_publish. Models that MODELS lacks are built
there, from TACTUS_MESHES and from shapes. The quality of contact is measured in virtual time: the
same programs and models give the same rows. The memory of a process is its largest resident memory
in a run of 3 s in real time. --quick measures one small model, tool and pool size.
Exit codes: 0 done, 2 a program failed, 3 usage.
"""

import datetime
import json
import os
import pathlib
import platform
import re
import subprocess
import sys
import time

import results

DIAGONAL_M = 0.2
SHAPES = {"200 k faces": 200_000, "1 M faces": 1_000_000, "4 M faces": 4_000_000}
TOOLS = {"sphere, 2 mm": "sphere:0.002", "sphere, 5 mm": "sphere:0.005",
         "box, 10 mm": "box:0.01,0.008,0.004,0.0005", "mesh, 20 mm": "mesh:{probe},0.0005"}
POOLS_MIB = (1, 2, 4, 8, 16)
SECONDS = 20
DOMAIN = "97"
LOOPBACK = ("<CycloneDDS><Domain><General><Interfaces><NetworkInterface name='lo'/></Interfaces>"
            "</General></Domain></CycloneDDS>")


def run(*command, may_fail=False):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True,
                          check=False)
    if done.returncode != 0 and not may_fail:
        raise results.Failure(f"{' '.join(map(str, command))}: {done.stderr.strip()}")
    return done.stdout + done.stderr


class Bench:
    def __init__(self, programs, folder, is_quick):
        self.programs, self.folder, self.is_quick = programs, folder, is_quick
        self.rows = []

    def add(self, case, metric, value, unit, **more):
        self.rows.append({"suite": "memory", "case": case, **more, "metric": metric,
                          "value": value, "unit": unit})

    def models(self):
        """Name and file of each model; builds those that are missing."""
        meshes = os.environ.get("TACTUS_MESHES")
        sources = {"69 k faces": [pathlib.Path(meshes) / "stanford-bunny.obj"]} if meshes else {}
        sources |= {name: ["--shape", "bumpy-sphere", "--faces", faces]
                    for name, faces in SHAPES.items()}
        if self.is_quick:
            sources = {"20 k faces": ["--shape", "bumpy-sphere", "--faces", 20_000]}
        for name, words in sources.items():
            path = self.folder / f"{name.replace(' ', '-')}.spm"
            if not path.exists():
                run(self.programs / "spm_build", *words, "--fit-diag", DIAGONAL_M, "-o", path)
            yield name, path

    def shape_of(self, tool):
        """Value of --tool; builds the model of a mesh tool if it is missing."""
        probe = self.folder / "probe.spm"
        if "{probe}" in TOOLS[tool] and not probe.exists():
            run(self.programs / "spm_build", "--shape", "bumpy-sphere", "--faces", 1000,
                "--fit-diag", 0.02, "-o", probe)
        return TOOLS[tool].format(probe=probe)

    def touch(self, case, model, tool, pool_mib):
        """Quality of contact in virtual time."""
        report = self.folder / "touch.json"
        run(self.programs / "hrtc", model, "--virtual-time", "--duration",
            2 if self.is_quick else SECONDS, "--pool-mib", pool_mib, "--tool", self.shape_of(tool),
            "--report", report, "--log-level", "error")
        told = json.loads(report.read_text(encoding="utf-8"))
        answers, of_tool = told["answers"], told["tools"][0]
        frames = sum(answers[kind] for kind in ("exact", "separated", "within_tolerance",
                                                "bounded", "stale"))
        waits = max(answers["bounded"], of_tool["data_limited_frames"] + of_tool["halted_frames"])
        more = {"by": tool, "setting": f"{pool_mib} MiB"}
        self.add(case, "surface off by at most", 1e6 * answers["tolerated_max_m"], "um", **more)
        self.add(case, "waits for data", 100 * waits / frames, "%", **more)
        self.add(case, "exact or separated",
                 100 * (answers["exact"] + answers["separated"]) / frames, "%", **more)
        self.add(case, "whole model in the pools", int(told["models"][0]["static"]), "", **more)

    def pools(self, case, model):
        """Least pools, and those that hold the whole model."""
        refusal = run(self.programs / "hrtc", model, "--virtual-time", "--pool-mib", "0.25",
                      may_fail=True)
        least = re.search(r"at least ([0-9.]+) MiB", refusal)
        self.add(case, "least pools", float(least[1]) if least else 0.25, "MiB")
        report = self.folder / "whole.json"
        run(self.programs / "hrtc", model, "--virtual-time", "--duration", "0.1", "--pool-mib",
            "4096", "--report", report, "--log-level", "error")
        whole = json.loads(report.read_text(encoding="utf-8"))["pools"]["total_bytes"]
        self.add(case, "pools of the whole model", whole / 2**20, "MiB")
        self.add(case, "file", model.stat().st_size / 2**20, "MiB")

    def process(self, case, model, pool_mib):
        """Resident memory in real time, with the model from a file and from a server."""
        common = ["--duration", "3", "--pool-mib", str(pool_mib), "--tool", TOOLS["sphere, 2 mm"],
                  "--allow-no-rt", "--log-level", "error"]
        hrtc, publish = str(self.programs / "hrtc"), str(self.programs / "spm_publish")
        self.watch(case, [hrtc, str(model), *common], "hrtc, files", pool_mib)
        with subprocess.Popen([publish, str(model), "--domain", DOMAIN, "--log-level", "error"],
                              stdout=subprocess.DEVNULL) as server:
            try:
                self.watch(case, [hrtc, "--model", model.stem, "--domain", DOMAIN, *common],
                           "hrtc, DDS", pool_mib)
                self.add(case, "process", highest(server.pid), "MiB", by="spm_publish")
            finally:
                server.terminate()

    def watch(self, case, command, name, pool_mib):
        with subprocess.Popen(command, stdout=subprocess.DEVNULL) as process:
            most = 0.0
            while process.poll() is None:
                most = max(most, highest(process.pid))
                time.sleep(0.1)
        if process.returncode not in (0, 1):
            raise results.Failure(f"{' '.join(command)}: exit code {process.returncode}")
        self.add(case, "process", most, "MiB", by=name, setting=f"{pool_mib} MiB")


def highest(process):
    """Most resident memory of a process so far, in MiB; 0 of one that has ended."""
    try:
        status = pathlib.Path(f"/proc/{process}/status").read_text(encoding="utf-8")
    except OSError:
        return 0.0
    found = re.search(r"VmHWM:\s+(\d+)", status)
    return int(found[1]) / 1024 if found else 0.0


def machine():
    cpu = re.search(r"model name\s*: (.*)",
                    pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8"))
    return {"processor": cpu[1] if cpu else platform.machine(), "processors": os.cpu_count(),
            "kernel": f"{platform.system()} {platform.release()} {platform.machine()}",
            "load_average": os.getloadavg()[0],
            "date_utc": datetime.datetime.now(datetime.timezone.utc).isoformat("T", "seconds")}


def main(arguments):
    is_quick = "--quick" in arguments
    paths = [pathlib.Path(word) for word in arguments if word != "--quick"]
    if len(paths) != 3:
        print(__doc__, file=sys.stderr)
        return 3
    programs, folder, file = paths
    folder.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("CYCLONEDDS_URI", LOOPBACK)
    bench = Bench(programs, folder, is_quick)
    head = {"schema": 2, "commit": commit(), "machine": machine(), "quick": is_quick,
            "options": ["--quick"] if is_quick else [], "compiler": compiler(),
            "remarks": f"python3 tests/bench/memory.py; models {DIAGONAL_M} m across, hrtc "
                       f"--virtual-time --duration {SECONDS}, simulated operator, 500 N/m"}
    for case, model in bench.models():
        bench.pools(case, model)
        for tool in list(TOOLS)[:1 if is_quick else None]:
            for pool_mib in POOLS_MIB[1:2] if is_quick else POOLS_MIB:
                bench.touch(case, model, tool, pool_mib)
        for pool_mib in (2,) if is_quick else (2, 16):
            bench.process(case, model, pool_mib)
    results.write(file, head | {"rows": bench.rows})
    return 0


def compiler():
    """Version of g++, which has built PROGRAMS as a rule."""
    return run("g++", "-dumpfullversion").strip()


def commit():
    done = results.git(pathlib.Path(__file__).parent, "rev-parse", "--short=12", "HEAD")
    return done.stdout.strip() if done and done.returncode == 0 else "unknown"


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except (results.Failure, OSError, KeyError, ValueError) as error:
        print(f"memory.py: {error}", file=sys.stderr)
        sys.exit(2)
