#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""Keeps the tables of docs/benchmarks.md what tactus_bench measures.

    page_tables.py check PAGE RESULTS...      the tables' form is that of these results
    page_tables.py write PAGE RESULTS         puts a run's figures into the tables
    page_tables.py counts PAGE TACTUS_BENCH [--instructions] [--write]
                                              counts anew and compares, or writes, the suite's table

RESULTS are files of tactus_bench --json. A table of the page that a suite fills has above it

    <!-- tactus_bench SUITE; FIELD=VALUE; ...
    | {case} | {METRIC} / {METRIC; FIELD=VALUE} | {METRIC?} | {METRIC; peer} |
    -->
    *Full run of DATE, ...*

The rows of the suite with these fields (part, case, by, setting, scene, metric, unit) fill it, by
the pattern of a line. Cells with a field's name, or {model} for case and scene, {column} for metric
and unit, say which rows a line is of. The others are figures: goals stand in brackets behind, and
what misses them is bold. `peer` takes the peer's value of that row, `?` marks what isn't in every
run: it stays as it is when the results lack it, and is not judged. Which lines there are is the
page's choice; a table without lines takes all. The line in italics tells of the last run; a table
without it is the same on every machine.

check: each table parses, figures are numbers, and the results have the suite's columns. No figure
is judged. write: nothing but figures and lines in italics changes; tables and lines that the run
has no rows for stay and are named; a quick run never goes over a full one. counts: must be as
written; instructions a frame, with --instructions (under valgrind's callgrind, some seconds), may be
off by 2 %: they are the compiler's, too.
Exit codes: 0 done, 1 the page is wrong or a table was refused, 2 failed, 3 usage, 77 no valgrind.
"""

import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

INSTRUCTIONS = "instructions a frame"
TOLERANCE = 0.02
ENTRY = "tactus::Frame::run(*"  # What is counted, and all that it calls.
LEAST = 1e-12  # Below this a figure is rounding, and told as 0.

FIELDS = ("suite", "part", "case", "by", "setting", "scene", "metric", "unit", "model", "column")
JUDGED = ("part", "metric", "unit", "column")  # Of these a quick run has what a full one has.
MARK = "<!-- tactus_bench "
TABLE = re.compile(r"<!-- tactus_bench (?P<head>[^\n]*)\n(?P<pattern>\|[^\n]*\|)\n-->\n"
                   r"(?P<run>\*(?:Full|Quick) run of [^\n]*\*\n)?\n(?P<lines>(?:\|[^\n]*\|\n)+)")
HOLE = re.compile(r"\{([^{}]*)\}")
NUMBER = r"(?:none|-?\d+(?:,\d{3})*(?:\.\d+)?(?:e-?\d+)?)"
FIGURE = rf"(?:\*\*{NUMBER}\*\* \({NUMBER}\)|{NUMBER}(?: \({NUMBER}\))?|-)"


class Failure(Exception):
    """A step that could not be done."""


def cells_of(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def line_of(cells):
    return f"| {' | '.join(cells)} |\n"


class Hole:
    """One figure of the pattern: the rows it may be of."""

    def __init__(self, text):
        self.source = text
        self.is_optional = text.endswith("?")
        metric, *words = (word.strip() for word in text.removesuffix("?").split(";"))
        if metric:
            words.append(metric if metric.split("=")[0] in FIELDS else f"metric={metric}")
        self.value_key = "peer_value" if "peer" in words else "value"
        self.wanted = conditions([word for word in words if word != "peer"])

    def is_in(self, rows):
        """Whether a row could fill it, on whatever model and with whatever setting."""
        return any(has(row, judged(self.wanted)) for row in rows)

    def rows(self, rows):
        return [row for row in rows if has(row, self.wanted) and self.value_key in row]

    def text(self, rows):
        """None when no row fills it."""
        found = self.rows(rows)
        if len(found) > 1:
            raise Failure(f"'{self.source}': {len(found)} rows have it; say which by more fields")
        if not found:
            return None
        text = number(found[0][self.value_key])
        if self.value_key != "value" or "goal" not in found[0]:
            return text
        return f"{text if found[0]['met'] else f'**{text}**'} ({number(found[0]['goal'])})"


class Table:
    """A marked table of the page."""

    def __init__(self, match, line_number):
        suite, *words = (word.strip() for word in match["head"].split(";"))
        self.wanted = {"suite": suite} | conditions(words)
        self.where = f"line {line_number}, {match['head'].strip()}"
        self.pattern = cells_of(match["pattern"])
        self.run = match["run"] or ""
        self.span = match.span("run")[0], match.end()
        if self.span[0] < 0:
            self.span = match.start("lines") - 1, match.end()
        self.head, *self.lines = map(cells_of, match["lines"].splitlines())
        if not self.lines or set("".join(self.lines.pop(0))) != {"-"}:
            raise Failure(f"{self.where}: no line of --- below the head")
        holes = [HOLE.findall(cell) for cell in self.pattern]
        self.is_name = [any(hole.removesuffix("?") in FIELDS for hole in cell) for cell in holes]
        self.holes = [[] if is_name else [Hole(hole) for hole in cell]
                      for cell, is_name in zip(holes, self.is_name)]
        if any(len({hole.is_optional for hole in cell}) > 1 for cell in self.holes):
            raise Failure(f"{self.where}: a cell has figures with ? and without")
        if not any(self.is_name) or not any(self.holes):
            raise Failure(f"{self.where}: the pattern needs a field's name and a figure")

    def name_of(self, row):
        """The cells of a line by which a row belongs to it."""
        return tuple(HOLE.sub(lambda hole: row.get(hole[1].removesuffix("?"), ""), cell)
                     for cell, is_name in zip(self.pattern, self.is_name) if is_name)

    def name_in(self, line):
        return tuple(cell for cell, is_name in zip(line, self.is_name) if is_name)

    def grouped(self, rows):
        """{name: rows}, in their order, of the rows that can be in this table."""
        groups = {}
        for row in rows:
            if has(row, self.wanted):
                groups.setdefault(self.name_of(row), []).append(row)
        return {name: group for name, group in groups.items()
                if any(hole.rows(group) for cell in self.holes for hole in cell)}

    def filled(self, name, rows, old):
        """A line's cells; `old` are those that stay where optional figures are missing."""
        names, line = iter(name), []
        for cell, is_name, holes, kept in zip(self.pattern, self.is_name, self.holes, old):
            if is_name:
                line.append(next(names))
                continue
            texts = [hole.text(rows) for hole in holes]
            if not any(texts):
                line.append(kept if any(hole.is_optional for hole in holes) else "")
            else:
                each = iter(texts)
                line.append(HOLE.sub(lambda _, each=each: next(each) or "-", cell))
        return line

    def faults(self, rows):
        """What is wrong with its form, held against a run's rows."""
        own = [row for row in rows if has(row, {"suite": self.wanted["suite"]})]
        if not own:
            yield f"there are no results of a suite '{self.wanted['suite']}'"
            return
        part = [row for row in own if has(row, judged(self.wanted))]
        for hole in (hole for cell in self.holes for hole in cell):
            if not hole.is_optional and not hole.is_in(part):
                yield f"the suite has no column '{hole.source}'"
        if len(self.head) != len(self.pattern):
            yield f"{len(self.head)} columns, {len(self.pattern)} in the pattern"
        names = [self.name_in(line) for line in self.lines]
        for name in {name for name in names if names.count(name) > 1}:
            yield f"two lines '{', '.join(name)}'"
        known = [{HOLE.sub(lambda hole, row=row: row.get(hole[1], ""), cell) for row in part}
                 for cell in self.pattern]
        for line in self.lines:
            yield from self.line_faults(line, known)

    def line_faults(self, line, known):
        if len(line) != len(self.pattern):
            yield f"the line '{line[0]}' has {len(line)} cells, not {len(self.pattern)}"
            return
        for text, cell, is_name, names in zip(line, self.pattern, self.is_name, known):
            if not is_name:
                form = FIGURE.join(map(re.escape, HOLE.sub("\0", cell).split("\0")))
                if text and not re.fullmatch(form, text):
                    yield f"the line '{line[0]}': '{text}' is not '{cell}' with numbers"
            elif set(HOLE.findall(cell)) <= set(JUDGED) and text not in names:
                yield f"the suite has no '{text}'"

    def text(self):
        return self.run + "\n" + "".join(map(line_of, [self.head, ["---"] * len(self.head),
                                                       *self.lines]))


def conditions(words):
    pairs = [word.split("=", 1) for word in words]
    for pair in pairs:
        if len(pair) != 2 or pair[0] not in FIELDS:
            raise Failure(f"'{'='.join(pair)}': not FIELD=VALUE with one of {', '.join(FIELDS)}")
    return dict(pairs)


def judged(wanted):
    return {field: value for field, value in wanted.items() if field in JUDGED}


def has(row, wanted):
    return all(row.get(field, "") == value for field, value in wanted.items())


def number(value):
    """Whole numbers and from 100 on without a fraction, everything else with three digits."""
    if value is None or not math.isfinite(value):
        return "none"
    if abs(value) < LEAST:
        return "0"
    if abs(value) >= 100 or value == round(value):
        return f"{value:,.0f}"
    return re.sub(r"e-0(\d)$", r"e-\1", f"{value:.3g}")


def tables_in(page):
    tables = [Table(match, page.count("\n", 0, match.start()) + 1)
              for match in TABLE.finditer(page)]
    starts = {match.start() for match in TABLE.finditer(page)}
    for mark in re.finditer(re.escape(MARK), page):
        if mark.start() not in starts:
            raise Failure(f"line {page.count(chr(10), 0, mark.start()) + 1}: no pattern, or no "
                          "table an empty line below, after the mark")
    if not tables:
        raise Failure("no marked table in the page")
    return tables


def page_with(page, tables):
    for table in reversed(tables):
        page = page[:table.span[0]] + table.text() + page[table.span[1]:]
    return page


def read_results(path):
    try:
        results = json.loads(path.read_text(encoding="utf-8"))
        for row in results["rows"]:
            known_as, scene = row["case"], row["scene"]
            row["model"] = known_as if known_as == scene else f"{known_as} ({scene})"
            row["column"] = f"{row['metric']}, {row['unit']}".removesuffix(", ")
        return results
    except (ValueError, KeyError, TypeError) as error:
        raise Failure(f"{path}: not the results of tactus_bench --json: {error}") from error


def run_line(results, kept):
    machine = results["machine"]
    return (f"*{'Quick' if results['quick'] else 'Full'} run of {machine['date_utc'][:10]}, commit "
            f"{results['commit']}: {machine['processor']}, {machine['processors']} processors, "
            f"{machine['kernel']}, compiler {results['compiler']}."
            f"{' From earlier runs: ' + '; '.join(kept) + '.' if kept else ''}*\n")


def refusal(table, results, groups):
    """Why the table must stay as it is, and whether that is a fault; None when it can be written."""
    suite = table.wanted["suite"]
    if any(line.startswith(suite + " ") for line in results.get("failures", [])):
        return "its suite failed", True
    if not groups:
        return "the run has no rows for it", False
    if results["quick"] and table.run.startswith("*Full"):
        return "it is of a full run, these results are of a quick one", True
    return None


def write_table(table, results):
    """Returns as refusal() does."""
    groups = table.grouped(results["rows"])
    old = {table.name_in(line): line for line in table.lines}
    if old:
        groups = {name: rows for name, rows in groups.items() if name in old}
    if reason := refusal(table, results, groups):
        return reason
    nothing = [""] * len(table.pattern)
    table.lines = [table.filled(name, groups[name], old.get(name, nothing))
                   if name in groups else old[name] for name in old or groups]
    if table.run:
        table.run = run_line(results, [", ".join(name) for name in old if name not in groups])
    return None


def check(page_path, *paths):
    rows = [row for path in paths for row in read_results(path)["rows"]]
    tables = tables_in(page_path.read_text(encoding="utf-8"))
    found = [f"{table.where}: {fault}" for table in tables for fault in table.faults(rows)]
    print("\n".join(found) if found else f"{len(tables)} tables are as the suites print them")
    return 1 if found else 0


def write(page_path, path):
    page = page_path.read_text(encoding="utf-8")
    tables, results = tables_in(page), read_results(path)
    reasons = [(table, write_table(table, results)) for table in tables]
    page_path.write_text(page_with(page, tables), encoding="utf-8")
    for table, reason in reasons:
        print(f"{table.where}: {'left: ' + reason[0] if reason else 'written'}")
    return 1 if any(reason and reason[1] for _, reason in reasons) else 0


def run(words):
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines() or ["no word"]
        raise Failure(f"{' '.join(map(str, words))}: ended with {done.returncode}: {lines[-1]}")


def instructions_a_frame(bench, folder, case, frames):
    out = folder / "callgrind.out"
    run(["valgrind", "--tool=callgrind", f"--toggle-collect={ENTRY}", f"--callgrind-out-file={out}",
         bench, "counts", "--cache", folder, "--only", case])
    total = re.search(r"^(?:summary|totals): (\d+)", out.read_text(), re.MULTILINE)
    if total is None or int(total.group(1)) == 0:
        raise Failure(f"callgrind counted nothing in {ENTRY}")
    return round(int(total.group(1)) / frames)


def count(bench, with_instructions):
    """The results of the suite as this build has it."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        out = folder / "counts.json"
        run([bench, "counts", "--cache", folder, "--json", out])
        results = read_results(out)
        frames = [row for row in results["rows"] if row["metric"] == "frames in all"]
        for row in frames if with_instructions else []:
            value = instructions_a_frame(bench, folder, row["case"], row["value"])
            results["rows"].append(row | {"metric": INSTRUCTIONS, "value": value})
    return results


def differences(table, results):
    groups = table.grouped(results["rows"])
    written = {table.name_in(line): line for line in table.lines}
    for name in written.keys() ^ groups.keys():
        yield f"{', '.join(name)}: only {'written' if name in written else 'counted'}"
    for name in written.keys() & groups.keys():
        counted = table.filled(name, groups[name], written[name])
        for column, old, new in zip(table.head, written[name], counted):
            allowed = 0
            if column == INSTRUCTIONS and old and new:
                allowed = TOLERANCE * float(old.replace(",", ""))
            if new != old and not (allowed and abs(float(new.replace(",", ""))
                                                   - float(old.replace(",", ""))) <= allowed):
                yield f"{', '.join(name)}: {column}: {new} counted, {old} written"


def counts(page_path, bench, options):
    if "--instructions" in options:
        missing = [] if shutil.which("valgrind") else ["valgrind"]
        if "avx2" not in pathlib.Path("/proc/cpuinfo").read_text():
            missing.append("a processor with AVX2")
        if missing:
            print(f"skipped: there is no {' and no '.join(missing)}")
            return 77
    page = page_path.read_text(encoding="utf-8")
    tables = tables_in(page)
    own = [table for table in tables if table.wanted["suite"] == "counts"]
    if len(own) != 1:
        raise Failure(f"{page_path}: {len(own)} tables of the suite counts, not one")
    results = count(bench, "--instructions" in options)
    if "--write" in options:
        if reason := write_table(own[0], results):
            print(f"{own[0].where}: left: {reason[0]}")
            return 1
        page_path.write_text(page_with(page, tables), encoding="utf-8")
        return 0
    found = sorted(differences(own[0], results))
    for line in found:
        print(line)
    if found:
        print("If the change is meant: page_tables.py counts ... --instructions --write, and say "
              "why in the commit.")
    return 1 if found else 0


def main(arguments):
    options = [word for word in arguments if word.startswith("--")]
    command, *words = [word for word in arguments if not word.startswith("--")] or [""]
    paths = [pathlib.Path(word) for word in words]
    if command == "check" and len(paths) >= 2 and not options:
        return check(*paths)
    if command == "write" and len(paths) == 2 and not options:
        return write(*paths)
    if command == "counts" and len(paths) == 2 and set(options) <= {"--instructions", "--write"}:
        return counts(*paths, options)
    print(__doc__, file=sys.stderr)
    return 3


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except (Failure, OSError, ValueError) as error:
        print(f"page_tables.py: {error}", file=sys.stderr)
        sys.exit(2)
