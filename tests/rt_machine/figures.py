# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""figures.py FOLDER COMMIT [OPTION...]: the figures of rt_machine.sh's runs, as a table and as
FOLDER/rt.json, which has the form of tactus_bench --json. Exit code 1 when a goal is missed.

The machine counts instructions: one is a nanosecond. So the largest time of a stage, in ns, is the
most instructions that it ever took, interrupts included.
"""
import datetime
import json
import pathlib
import re
import sys

STAGES = ("load", "refine", "refit", "query", "force", "frame")
RUNS = {"alone": "1 kHz, 200,000 faces", "load": "1 kHz, 200,000 faces, load beside",
        "mesh": "1 kHz, 200,000 faces, a mesh of 1,000 faces as tool",
        "fast": "4 kHz, 2,000 faces, 80 us a frame", "minute": "1 kHz, 200,000 faces, over DDS",
        "network": "1 kHz, over DDS, 10 ms and 1 % lost each way", "services": "service", "faults": "service, killed, back inside a model"}
# Limits of all runs except one whose hand starts deep inside a model, and bounds of every image.
GOALS = {"missed": 0, "overruns": 0, "wake max": 20, "cyclictest max": 20, "exposure": 3.0}

folder, commit, *options = sys.argv[1:]
folder = pathlib.Path(folder)
rows = []


def add(case, metric, value, unit=""):
    row = {"case": case, "metric": metric, "value": value, "unit": unit}
    goal = GOALS.get(metric) if case != RUNS["faults"] else None
    if goal is not None:
        row |= {"goal": goal, "met": value <= goal}
    rows.append(row)


def add_run(case, report):
    deadline = report["deadline"]
    add(case, "cycles", report["frames"])
    add(case, "missed", deadline["missed"])
    add(case, "overruns", deadline["overrun"])
    for name in ("response", "wake", "cpu"):
        for quantile in ("p50", "p99", "max"):
            value = report["times_us"][name][quantile]
            add(case, f"{name} {quantile}", round(value, 1), "us")
    for stage in STAGES:
        most = report["times_us"][stage]["max"]
        add(case, f"{stage}, most", round(most * 1000), "instructions")
    if report["wire"]["arrival_ms"]["max"] > 0:
        for quantile in ("p50", "p99", "max"):
            value = report["wire"]["arrival_ms"][quantile]
            add(case, f"arrival {quantile}", round(value, 1), "ms")
        add(case, "stale", report["answers"]["stale"])


kernel = ""
for name, case in RUNS.items():
    path = folder / name / "report.json"
    if not path.exists():
        continue
    whole = json.loads(path.read_text(encoding="utf-8"))
    kernel = whole["machine"]["kernel"] + " " + whole["machine"]["preemption"]
    if "alone" in whole:
        add_run(case + ": alone", whole["alone"])
    add_run(case, whole)
    yardstick = folder / name / "cyclictest.txt"
    if yardstick.exists():
        told = re.search(r"Min: *(\d+).*Avg: *(\d+) *Max: *(\d+)", yardstick.read_text())
        for quantile, value in zip(("min", "avg", "max"), told.groups()):
            add(case, f"cyclictest {quantile}", int(value), "us")
told = folder / "faults" / "faults.txt"
if told.exists():
    for line in told.read_text(encoding="utf-8").splitlines():
        if killed := re.match(r"(\w+) killed: force gone after (\d+) ms, back after (\d+) ms", line):
            add(f"{killed[1]} killed", "force gone after", int(killed[2]), "ms")
            add(f"{killed[1]} killed", "force back after", int(killed[3]), "ms")

told = folder / "services" / "secured.txt"
if told.exists():
    for line in told.read_text(encoding="utf-8").splitlines():
        if spent := re.match(r"to secured services: (\d+) commands, ([0-9.]+) s", line):
            add("keys and services", "commands", int(spent[1]))
            add("keys and services", "time", float(spent[2]), "s")
        elif exposed := re.search(r"level for (\w+)\.service: ([0-9.]+) ", line):
            add(exposed[1], "exposure", float(exposed[2]))

suite = "rt" if "x86_64" in kernel else "rt_arm64"  # Name of its file in docs/benchmarks.
rows = [{"suite": suite} | row for row in rows]
results = {
    "schema": 2, "commit": commit,
    "machine": {"processor": "QEMU, one instruction a nanosecond", "processors": 1,
                "kernel": kernel,
                "date_utc": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d")},
    "quick": "--quick" in options, "options": options,
    "compiler": "that of the packages", "rows": rows}
(folder / "rt.json").write_text(json.dumps(results, indent=1), encoding="utf-8")
for row in rows:
    missed = "" if row.get("met", True) else f"  goal {row['goal']} missed"
    print(f"{row['case']:48} {row['metric']:20} {row['value']:>10} {row['unit']}{missed}")
sys.exit(any(not row.get("met", True) for row in rows))
