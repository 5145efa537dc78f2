#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""Holds what frames do on fixed scenes against docs/benchmarks/counts.json or worst.json.

    counts.py FILE TACTUS_BENCH [--instructions | --write]

Counts anew what the suite of the file's name counts. `counts`: each must be as in the file. With
--instructions those of a frame as well, under valgrind's callgrind, some seconds; they are the
compiler's, too, and may be off by 2 %. `worst`: with --instructions; no frame may cost more than the
file says, and 2 %. Only the file's cases are counted. --write puts all of it into the file.
Exit codes: 0 done, 1 a count differs, 2 failed, 3 usage, 77 no valgrind or no AVX2.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import results

INSTRUCTIONS = "instructions a frame"
MOST = "most of a frame"  # Metric of the suite worst, in instructions; an upper limit.
TOLERANCE = 0.02
ENTRY = "tactus::Frame::run(*"  # Counted function, with all that it calls.


def run(*words):
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines() or ["no word"]
        raise results.Failure(f"{' '.join(map(str, words))}: ended with {done.returncode}: "
                              f"{lines[-1]}")


def instructions_a_frame(bench, folder, case, frames):
    out = folder / "callgrind.out"
    run("valgrind", "--tool=callgrind", f"--toggle-collect={ENTRY}", f"--callgrind-out-file={out}",
        bench, "counts", "--cache", folder, "--only", case)
    total = re.search(r"^(?:summary|totals): (\d+)", out.read_text(), re.MULTILINE)
    if total is None or int(total[1]) == 0:
        raise results.Failure(f"callgrind counted nothing in {ENTRY}")
    return round(int(total[1]) / frames)


def count(bench, suite, with_instructions, cases):
    """Results of these cases of the suite from this build; none: all."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        is_worst = suite == "worst"
        run(bench, suite, "--cache", folder, "--json", folder / "counts.json",
            *(["--instructions"] if is_worst and with_instructions else []),
            *(word for case in cases for word in ("--only", case)))
        counted = results.read(folder / "counts.json")
        for row in [row for row in counted["rows"] if with_instructions and not is_worst
                    and row["metric"] == "frames in all"]:
            value = instructions_a_frame(bench, folder, row["case"], row["value"])
            counted["rows"].append(row | {"metric": INSTRUCTIONS, "value": value})
    return counted


def held(counted, with_instructions):
    """Compared values by name."""
    for row in counted["rows"]:
        is_held = row["metric"] == MOST if row["suite"] == "worst" else \
            with_instructions or row["metric"] != INSTRUCTIONS
        if is_held:
            yield results.name_of(row), row["metric"], row["value"]


def differences(expected, counted, with_instructions):
    old, new = ({name: (metric, value) for name, metric, value in held(one, with_instructions)}
                for one in (expected, counted))
    for name in dict.fromkeys([*old, *new]):
        (metric, was), (_, now) = old.get(name, ("", None)), new.get(name, ("", None))
        allowed = TOLERANCE * was if metric in (INSTRUCTIONS, MOST) else 0
        if was is None or now is None or now > was + allowed or \
                (now < was - allowed and metric != MOST):
            yield f"{name}: {now} counted, {was} expected"


def main(arguments):
    paths = [pathlib.Path(word) for word in arguments if not word.startswith("--")]
    options = [word for word in arguments if word.startswith("--")]
    if len(paths) != 2 or options not in ([], ["--instructions"], ["--write"]):
        print(__doc__, file=sys.stderr)
        return 3
    if options:
        missing = [] if shutil.which("valgrind") else ["valgrind"]
        if "avx2" not in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8"):
            missing.append("a processor with AVX2")
        if missing:
            print(f"skipped: there is no {' and no '.join(missing)}")
            return 77
    file, bench = paths
    kept = results.read(file)["rows"] if file.exists() else []
    counted = count(bench, file.stem, bool(options), dict.fromkeys(row["case"] for row in kept))
    if options == ["--write"]:
        results.write(file, counted)
        return 0
    found = list(differences(results.read(file), counted, bool(options)))
    if found:
        print("\n".join(found))
        print("If the change is meant: counts.py ... --write, and say why in the commit.")
    return 1 if found else 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except (results.Failure, OSError) as error:
        print(f"counts.py: {error}", file=sys.stderr)
        sys.exit(2)
