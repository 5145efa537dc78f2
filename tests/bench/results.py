#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""Keeps the results of full runs in docs/benchmarks, one file a suite.

    results.py store FOLDER RESULTS      files of a run of tactus_bench --json, one for each suite
    results.py check FOLDER PAGE... [RESULTS...]
                                         the files' form, and the tables of them in the pages (*.md)
                                         and in FOLDER's own

A file has what tactus_bench --json writes, a row a line. store leaves and names: a suite that failed;
one of a full run when the new one is not (--quick, --frames, --only ...) or lacks rows that it has;
and those that counts.py renews and tests compare with. check: each file, and RESULTS, have the
keys of HEADER and ROW; remarks and the pages name each commit that is not in the history of HEAD, where
there is one; the page shows each picture of the folder and no other; and each table that has above it

    <!-- benchmarks/SUITE.json ... -->

names no number that these files have not: a value, goal or peer's value, to the digits that the
page gives it. Bold are the values that miss their goal.
Exit codes: 0 done, 1 faults, or a suite was left as it is, 2 failed, 3 usage.
"""

import json
import pathlib
import re
import subprocess
import sys

HEADER = {"schema", "commit", "machine", "quick", "options", "compiler", "rows"}
MACHINE = {"processor", "processors", "kernel", "date_utc"}
ROW = {"suite", "case", "metric", "value", "unit"}
NAME = ("case", "by", "setting", "metric")  # Keys that distinguish the rows of a suite.
TOGETHER = {"goal": "met", "peer": "peer_value"}  # Fields that occur only together.
COUNTS = {"counts", "worst"}  # Suites that tests compare with.

TABLE = re.compile(r"<!--((?: benchmarks/\w+\.json)+) -->\n\n((?:\|.*\|\n)+)")
NUMBER = re.compile(r"(?<![\w.,-])-?\d+(?:,\d{3})*(?:\.\d+)?(?:e-?\d+)?(?![\w.])")
PICTURE = re.compile(r"!\[[^\]]*\]\((?:benchmarks/)?(\w+\.svg)\)")


class Failure(Exception):
    """Step that failed."""


def read(path):
    try:
        results = json.loads(path.read_text(encoding="utf-8"))
        if not isinstance(results["rows"], list):
            raise TypeError("no rows")
        return results
    except (ValueError, KeyError, TypeError) as error:
        raise Failure(f"{path}: not the results of tactus_bench --json: {error}") from error


def write(path, results):
    """One row a line, so that a diff shows the changes between runs."""
    head = json.dumps({key: value for key, value in results.items() if key != "rows"}, indent=2)
    rows = ",\n".join("    " + json.dumps(row) for row in results["rows"])
    path.write_text(f'{head[:-2]},\n  "rows": [\n{rows}\n  ]\n}}\n', encoding="utf-8")


def is_full(results):
    return not results["options"]


def name_of(row):
    return " ".join(row[key] for key in NAME if row.get(key))


def refusal(suite, results, path):
    """Reason why the suite's file must stay unchanged; None if it can be written."""
    if suite in COUNTS:
        return "what tests compare with; counts.py --write renews it"
    if any(text.startswith(f"{suite} ") for text in results.get("failures", [])):
        return "the suite failed"
    if not path.exists() or not is_full(kept := read(path)):
        return None
    if not is_full(results):
        return "it is of a full run, these results are not"
    found = {name_of(row) for row in results["rows"] if row["suite"] == suite}
    lost = [name for name in map(name_of, kept["rows"]) if name not in found]
    return f"{len(lost)} of its rows are not in these results, the first '{lost[0]}'; remove the " \
           "file if they are not wanted any more" if lost else None


def store(folder, path):
    results, code = read(path), 0
    for suite in dict.fromkeys(row["suite"] for row in results["rows"]):
        file = folder / f"{suite}.json"
        reason = refusal(suite, results, file)
        if reason is None:
            head = {key: value for key, value in results.items() if key != "failures"}
            write(file, head | {"rows": [row for row in results["rows"] if row["suite"] == suite]})
        elif suite not in COUNTS:
            code = 1
        print(f"{file}: {'left: ' + reason if reason else 'written'}")
    return code


def form_faults(results):
    yield from (f"no '{key}'" for key in sorted(HEADER - results.keys()))
    yield from (f"no 'machine.{key}'" for key in sorted(MACHINE - results.get("machine", {}).keys()))
    for row in results["rows"]:
        missing = ROW - row.keys() | {one for pair in TOGETHER.items() for one in pair
                                      if not row.keys().isdisjoint(pair) and one not in row}
        if missing:
            yield f"{row}: no {', '.join(sorted(missing))}"
        elif not isinstance(row["value"], (int, float, type(None))):
            yield f"{row}: its value is no number"


def told(value, text):
    """True if the page's text is that value, to its own digits."""
    digits = len(re.sub(r"e.*|[-,.]", "", text).lstrip("0")) or 1
    number = float(text.replace(",", ""))
    return abs(value - number) <= 1e-12 or float(f"{value:.{digits}g}") == number


def table_faults(page, folder):
    for files, lines in TABLE.findall(page):
        rows = [row for name in files.split() for row in read(folder.parent / name)["rows"]]
        values = [(row[key], key == "value" and row.get("met") is False) for row in rows
                  for key in ("value", "goal", "peer_value") if row.get(key) is not None]
        for cell in (cell for line in lines.splitlines()[2:] for cell in line.split("|")[2:]):
            for number in NUMBER.finditer(cell):
                is_bold = cell[:number.start()].endswith("**")
                if not any(told(value, number[0]) and missed == is_bold for value, missed in values):
                    yield (f"{files.strip()}: no {'missed ' if is_bold else ''}'{number[0]}' of "
                           f"the line '{cell.strip()}'")


def git(folder, *words):
    try:
        return subprocess.run(["git", "-C", folder, *words], check=False, capture_output=True,
                              text=True)
    except FileNotFoundError:
        return None


def history_faults(page, files, folder):
    """Commits outside the history must be marked as such."""
    depth = git(folder, "rev-parse", "--is-shallow-repository")
    if depth is None or depth.stdout.strip() != "false":
        return  # No repository, or a shallow one.
    for path in files:
        results = read(path)
        commit = results.get("commit", "")
        if git(folder, "merge-base", "--is-ancestor", commit, "HEAD").returncode == 0:
            continue
        if commit not in results.get("remarks", ""):
            yield f"{path}: commit '{commit}' is not in this history, and no remark says so"
        if commit not in page:
            yield f"{path}: commit '{commit}' is not in this history, and the page doesn't say so"


def check(folder, *given):
    page = "\n".join(path.read_text(encoding="utf-8")
                     for path in [*given, *sorted(folder.glob("*"))] if path.suffix == ".md")
    others = [path for path in given if path.suffix != ".md"]
    files = sorted(folder.glob("*.json"))
    found = [f"{path}: {fault}" for path in [*files, *others] for fault in form_faults(read(path))]
    found += [f"{path}: a row of another suite" for path in files
              if {row.get("suite") for row in read(path)["rows"]} != {path.stem}]
    pictures = {path.name for path in folder.glob("*.svg")}
    found += [f"{name}: not on the page, or not in the folder"
              for name in sorted(pictures ^ set(PICTURE.findall(page)))]
    found += table_faults(page, folder)
    found += history_faults(page, files, folder)
    print("\n".join(found) if found else f"{len(files)} files, {len(TABLE.findall(page))} tables, "
          f"{len(pictures)} pictures")
    return 1 if found or not files else 0


def main(arguments):
    command, *paths = arguments or [""]
    paths = [pathlib.Path(path) for path in paths]
    if command == "store" and len(paths) == 2:
        return store(*paths)
    if command == "check" and len(paths) >= 2:
        return check(*paths)
    print(__doc__, file=sys.stderr)
    return 3


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except (Failure, OSError) as error:
        print(f"results.py: {error}", file=sys.stderr)
        sys.exit(2)
