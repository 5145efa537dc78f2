#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""Compares the table "Counts" of docs/benchmarks.md with what this build counts.

    check_counts.py TACTUS_BENCH PAGE [--instructions] [--write]

Counts must be as they are written. Instructions a frame, with --instructions (under valgrind's
callgrind, some seconds), may be off by 2 %: they are the compiler's, too. --write puts the new
table into the page instead. Exit codes: 0 they agree, 1 they don't, 2 failed, 3 usage, 77 there is no valgrind.
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HEADING = "## Counts\n"
INSTRUCTIONS = "instructions a frame"
TOLERANCE = 0.02
ENTRY = "tactus::Frame::run(*"  # What is counted, and all that it calls.


class Failure(Exception):
    """A step that could not be done."""


def run(words):
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines() or ["no word"]
        raise Failure(f"{' '.join(map(str, words))}: ended with {done.returncode}: {lines[-1]}")
    return done


def count(bench, folder):
    """{case: {column: value}} as this build has it."""
    out = folder / "counts.json"
    run([bench, "counts", "--cache", folder, "--json", out])
    counted = {}
    for row in json.loads(out.read_text())["rows"]:
        counted.setdefault(row["case"], {})[row["metric"]] = round(row["value"])
    return counted


def instructions_a_frame(bench, folder, case, frames):
    out = folder / "callgrind.out"
    run(["valgrind", "--tool=callgrind", f"--toggle-collect={ENTRY}", f"--callgrind-out-file={out}",
         bench, "counts", "--cache", folder, "--only", case])
    total = re.search(r"^(?:summary|totals): (\d+)", out.read_text(), re.MULTILINE)
    if total is None or int(total.group(1)) == 0:
        raise Failure(f"callgrind counted nothing in {ENTRY}")
    return round(int(total.group(1)) / frames)


def table_of(page):
    """The first table below the heading, as ({case: {column: value}}, its start, its end)."""
    begin = page.find(HEADING)
    lines = re.search(r"(?:^\|.*\n)+", page[begin:], re.MULTILINE) if begin >= 0 else None
    if lines is None:
        raise Failure(f"no table below '{HEADING.strip()}'")
    cells = [[cell.strip() for cell in line.strip("|").split("|")]
             for line in lines.group(0).splitlines()]
    columns = cells[0][1:]
    written = {}
    for line in cells[2:]:
        if len(line) != len(cells[0]):
            raise Failure(f"the table's line '{line[0]}' has {len(line)} cells, not {len(cells[0])}")
        written[line[0]] = {column: int(cell.replace(",", ""))
                            for column, cell in zip(columns, line[1:])}
    return written, begin + lines.start(), begin + lines.end()


def text_of(counted):
    columns = list(next(iter(counted.values())))
    lines = [["case", *columns], ["---"] * (len(columns) + 1)]
    lines += [[case, *(f"{values[column]:,}" for column in columns)]
              for case, values in counted.items()]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def differences(written, counted):
    for case in written.keys() | counted.keys():
        here, there = counted.get(case, {}), written.get(case, {})
        for column in (here.keys() | there.keys()):
            old, new = there.get(column), here.get(column)
            if column == INSTRUCTIONS and new is None:
                continue  # Not asked for.
            allowed = TOLERANCE * (old or 0) if column == INSTRUCTIONS else 0
            if old is None or new is None or abs(new - old) > allowed:
                yield f"{case}: {column}: {new} counted, {old} written"


def main(arguments):
    options = [word for word in arguments if word.startswith("--")]
    paths = [pathlib.Path(word) for word in arguments if not word.startswith("--")]
    if len(paths) != 2 or not set(options) <= {"--instructions", "--write"}:
        print(__doc__, file=sys.stderr)
        return 3
    if "--instructions" in options:
        missing = [] if shutil.which("valgrind") else ["valgrind"]
        if "avx2" not in pathlib.Path("/proc/cpuinfo").read_text():
            missing.append("a processor with AVX2")
        if missing:
            print(f"skipped: there is no {' and no '.join(missing)}")
            return 77
    bench, page_path = paths
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        counted = count(bench, folder)
        if "--instructions" in options:
            for case, values in counted.items():
                values[INSTRUCTIONS] = instructions_a_frame(bench, folder, case,
                                                            values["frames in all"])
    page = page_path.read_text()
    written, begin, end = table_of(page)
    if "--write" in options:
        for case, values in counted.items():  # What was not asked for stays as it is.
            if INSTRUCTIONS not in values and INSTRUCTIONS in written.get(case, {}):
                values[INSTRUCTIONS] = written[case][INSTRUCTIONS]
        page_path.write_text(page[:begin] + text_of(counted) + page[end:])
        return 0
    found = sorted(differences(written, counted))
    for line in found:
        print(line)
    if found:
        print("If the change is meant: check_counts.py ... --instructions --write, and say why in "
              "the commit.")
    return 1 if found else 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except (Failure, OSError, ValueError) as error:
        print(f"check_counts.py: {error}", file=sys.stderr)
        sys.exit(2)
