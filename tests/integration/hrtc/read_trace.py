#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""read_trace.py TRACE REPORT: the output of `hrtc --trace` is a trace of Chrome's format for the
run in the report: each frame's stages are in it in order, no two frames overlap, and nothing is
duplicated or left out except as reported."""
import json
import sys

STAGES = ["load", "refine", "refit", "query", "force", "write"]

with open(sys.argv[1], encoding="ascii") as file:
    trace = json.load(file)
with open(sys.argv[2], encoding="utf-8") as file:
    report = json.load(file)
rows, frames, rounds, instants = {}, [], [], []
inside = None
for event in trace["traceEvents"]:
    assert event["pid"] == 1 and event["ph"] in "MXi", event
    if event["ph"] == "M":
        if event["name"] == "thread_name":
            rows[event["tid"]] = event["args"]["name"]
        continue
    row = rows[event["tid"]]
    if event["ph"] == "i":
        assert event["s"] == "t" and (row, event["name"]) in {
            ("haptic loop", "deadline missed"), ("queues", "taken"), ("queues", "requests")}, event
        instants.append(event)
    elif event["name"] == "round":
        assert row == "chunk loader" and event["dur"] >= 0.0, event
        rounds.append(event)
    elif event["name"] == "frame":
        assert row == "haptic loop" and event["dur"] > 0.0, event
        frames.append((event, []))
    else:
        assert row == "haptic loop" and event["dur"] >= 0.0, event
        frames[-1][1].append(event)
assert sorted(rows.values()) == ["chunk loader", "haptic loop", "queues"], rows

end = None
for frame, stages in frames:
    assert [stage["name"] for stage in stages] == STAGES, stages
    at = frame["ts"]
    assert end is None or at >= end, "frames overlap"
    for stage in stages:
        assert abs(stage["ts"] - at) < 0.002, "a stage doesn't follow the one before"
        at = stage["ts"] + stage["dur"]
    assert abs(at - (frame["ts"] + frame["dur"])) < 0.002, "the stages aren't the frame"
    end = at
numbers = [frame["args"]["frame"] for frame, _ in frames]
said = report["trace"]
assert len(frames) == said["frames"] and len(rounds) == said["rounds"], said
assert trace["otherData"]["lost"] == said["lost"], said
assert numbers == sorted(set(numbers)), "a frame is told twice"
if said["lost"] == 0:
    assert numbers == list(range(report["frames"])), "a frame is missing"
    taken = sum(event["args"].get("arrivals", 0) for event in instants)
    assert taken == report["cache"]["loads"] or taken > 0, (taken, report["cache"])
    handed_over = sum(event["args"]["handed_over"] for event in rounds)
    assert handed_over >= taken > 0, (handed_over, taken)
    missed = [event for event in instants if event["name"] == "deadline missed"]
    assert len(missed) >= report["deadline"]["missed"], (len(missed), report["deadline"])
print(f"{len(frames)} frames, {len(rounds)} rounds, {said['bytes'] / len(frames):.0f} bytes a frame")
