# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""last_force.py LOG PROCESS SIGNAL HOW: commands of a device's motors when the program that drives
them ends. LOG has one line a change: monotonic time in ns, force in N, and its source. Waits for a
force of 0.3 N, sends the signal, waits for the end of the process and for a last line without a
force. HOW: `fades` if the force must fall in steps, or the required source of the last line. Exits
with 1 and a line otherwise."""
import os
import signal
import sys
import time

log, process, name, how = sys.argv[1], int(sys.argv[2]), sys.argv[3], sys.argv[4]
patience = time.monotonic() + 120


def wait_until(what, is_so):
    while not is_so():
        if time.monotonic() > patience:
            sys.exit(f"last_force: no {what}; the last lines: {lines()[-3:]}")
        time.sleep(0.001)


def lines():
    with open(log, encoding="ascii") as file:
        whole = [line.split() for line in file.read().split("\n")[:-1]]
    return [(int(ns), (float(x) ** 2 + float(y) ** 2 + float(z) ** 2) ** 0.5, who)
            for ns, x, y, z, who in whole]


def newest():
    """Only the last whole line: the log grows by a line a millisecond."""
    with open(log, "rb") as file:
        file.seek(max(0, os.path.getsize(log) - 400))
        whole = file.read().split(b"\n")[1:-1]
    if not whole:
        return 0.0
    return sum(float(x) ** 2 for x in whole[-1].split()[1:4]) ** 0.5


def has_ended():
    try:
        with open(f"/proc/{process}/stat", encoding="ascii") as file:
            return file.read().rsplit(")", 1)[1].split()[0] == "Z"
    except OSError:
        return True


wait_until("log", lambda: os.path.exists(log))
wait_until("force of 0.3 N", lambda: newest() > 0.3)
sent = time.monotonic_ns()
os.kill(process, getattr(signal, "SIG" + name))
wait_until("end of the process", has_ended)
wait_until("end of the force", lambda: newest() == 0.0)
told = lines()
last_with = max(i for i, (_, force, _) in enumerate(told) if force > 0.0)
first_without = told[last_with + 1]
before = [force for _, force, _ in told[max(0, last_with - 400):last_with + 1]]
steps = [force for force in before if 0.02 * max(before) < force < 0.95 * max(before)]
largest = max(a - b for a, b in zip(before, before[1:] + [0.0]))
print(f"{name}: {max(before):.2f} N, {len(steps)} forces on the way to zero, the largest step "
      f"{largest:.2f} N, zero {(first_without[0] - sent) / 1e6:.1f} ms after the signal, by "
      f"{first_without[2]}")
if how == "fades" and (len(steps) < 5 or largest > 0.25 * max(before)):
    sys.exit(f"last_force: {name}: the force does not fade: {before}")
if how != "fades" and first_without[2] != how:
    sys.exit(f"last_force: {name}: the last force was ended by {first_without[2]}")
