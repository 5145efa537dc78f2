#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""page_tables.py as a program: small pages and results go in, pages and exit codes come out."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).with_name("page_tables.py")

PAGE = """# Figures

Text | with a bar, {braces} and a *star*.

<!-- tactus_bench slide; part=A
| {model} | {by}, {setting} | {t.p50} / {t.p99} | {t.p50; peer} x | {size} | {by hand?} |
-->
*Full run of 2026-01-02: some machine.*

| model | who | time, us | theirs | size, B | by hand |
| --- | --- | --- | --- | --- | --- |
| cow (cow-5804) | ours, K 1 | 1 / **2** (1.5) | 3 x | 1,000 | 7 |
| igea | ours, K 1 | 4 / 5 |  |  |  |

| not marked | |
| --- | --- |
| stays | 1 |

<!-- tactus_bench counts
| {case} | {splits; part=B} | {instructions a frame?} |
-->

| case | splits | instructions a frame |
| --- | --- | --- |
| one | 12 | 10,000 |
| two | 1,234 | 20,000 |

The end.
"""


def row(suite, case, metric, value, **more):
    return {"suite": suite, "case": case, "metric": metric, "value": value, "unit": "us",
            "scene": case, **more}


def cow(metric, value, **more):
    return row("slide", "cow", metric, value, **{"part": "A", "by": "ours", "setting": "K 1",
                                                 "scene": "cow-5804", **more})


COUNTS = [row("counts", "one", "splits", 12, part="B", unit=""),
          row("counts", "two", "splits", 1234, part="B", unit="")]
ROWS = [cow("t.p50", 1.2345, peer="them", peer_value=0.00001234),
        cow("t.p99", 30.04, goal=20.0, met=False),
        cow("size", 12345.6), cow("t.p50", 9.0, setting="K 2"), cow("size", 9.0, part="Z"), *COUNTS]


def results(rows, quick=False, **more):
    return {"commit": "abc", "machine": {"kernel": "Linux 1", "processor": "CPU", "processors": 2,
                                         "date_utc": "2026-03-04T05:06:07Z"},
            "quick": quick, "compiler": "12", "rows": rows, **more}


class PageTables(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.page = self.folder / "page.md"
        self.results = self.folder / "results.json"
        self.page.write_text(PAGE)

    def sut(self, command, *words):
        path = f"{self.folder}{os.pathsep}{os.environ['PATH']}"
        done = subprocess.run([sys.executable, "-B", SCRIPT, command, *words], check=False,
                              capture_output=True, text=True, env={**os.environ, "PATH": path})
        self.said = done.stdout
        if done.returncode == 2:
            self.assertRegex(done.stderr, r"\Apage_tables\.py: .*\n\Z")  # One clear line.
            self.said = done.stderr
        return done.returncode

    def check(self, page=PAGE, rows=tuple(ROWS)):
        self.page.write_text(page)
        self.results.write_text(json.dumps(results(list(rows))))
        return self.sut("check", self.page, self.results)

    def write(self, rows=tuple(ROWS), page=PAGE, **more):
        self.page.write_text(page)
        self.results.write_text(json.dumps(results(list(rows), **more)))
        return self.sut("write", self.page, self.results)

    def assert_refused(self, code, text):
        """`code` of a call before: it says what was refused."""
        self.assertNotEqual(code, 0)
        self.assertIn(text, self.said)

    # --- check

    def test_a_page_of_the_suites_columns_passes(self):
        self.assertEqual(self.check(), 0, self.said)

    def test_results_may_come_in_several_files(self):
        other = self.folder / "other.json"
        other.write_text(json.dumps(results(COUNTS)))
        self.results.write_text(json.dumps(results(ROWS[:-2])))
        self.assertEqual(self.sut("check", self.page, self.results), 1)
        self.assertEqual(self.sut("check", self.page, self.results, other), 0)

    def test_a_renamed_column_is_found(self):
        for old in ("t.p50", "t.p99", "size", "splits"):
            rows = [one | {"metric": "new"} if one["metric"] == old else one for one in ROWS]
            with self.subTest(old):
                self.assertEqual(self.check(rows=rows), 1)
                self.assertIn(f"no column '{old}", self.said)

    def test_a_renamed_part_is_found(self):
        self.assertEqual(self.check(rows=[one | {"part": "C"} for one in ROWS]), 1)

    def test_names_of_columns_in_lines_are_judged_and_those_of_cases_are_not(self):
        page = PAGE.replace("{case} | {splits; part=B}", "{column} | {case=elsewhere}")
        self.assert_refused(self.check(page), "no 'one'")
        self.assertEqual(self.check(page.replace("| one", "| splits").replace(
            "| two | 1,234 | 20,000 |\n", "")), 0, self.said)

    def test_a_suite_that_is_not_there_is_found(self):
        self.assert_refused(self.check(PAGE.replace("bench slide", "bench glide")),
                            "no results of a suite 'glide'")

    def test_what_is_no_number_is_found(self):
        for old, new in (("1 / **2** (1.5)", "1 / two"), ("1 / **2** (1.5)", "1"),
                         ("4 / 5", "4, 5"), ("1,000", "1,00"), ("**2** (1.5)", "**2**"), ("3 x", "3"),
                         ("1,234", "12e")):
            with self.subTest(new):
                self.assertEqual(self.check(PAGE.replace(old, new)), 1)
                self.assertIn(f"'{new}'" if "**" not in new else "with numbers", self.said)

    def test_lines_of_other_lengths_and_double_lines_are_found(self):
        self.assert_refused(self.check(PAGE.replace("| 4 / 5 |", "|")), "5 cells, not 6")
        self.assert_refused(self.check(PAGE.replace("| theirs | size", "| size")), "5 columns, 6")
        self.assert_refused(self.check(PAGE.replace("| two |", "| one |")), "two lines 'one'")

    def test_damaged_tables_and_marks_are_refused(self):
        for old, new in (("-->\n*Full", "--> *Full"), ("*Full run", "*Some run"),
                         ("machine.*\n\n", "machine.*\n"), ("| {case} | {splits", "{case} | {splits"),
                         ("part=A", "pant=A"), ("{t.p50} /", "{t.p50?} /"),
                         ("part=A", "part"), ("{case} |", "case |"),
                         ("{splits; part=B} | {instructions a frame?}", "splits | instructions"),
                         ("| --- | --- | --- |\n| one", "| one")):
            with self.subTest(new):
                self.assertEqual(self.check(PAGE.replace(old, new)), 2)
        self.assertEqual(self.check("No table.\n"), 2)

    # --- write

    def test_figures_go_in_and_nothing_else_changes(self):
        self.assertEqual(self.write(), 0)
        self.assertEqual(self.page.read_text(), PAGE.replace(
            "*Full run of 2026-01-02: some machine.*",
            "*Full run of 2026-03-04, commit abc: CPU, 2 processors, Linux 1, compiler 12. "
            "From earlier runs: igea, ours, K 1.*").replace(
            "| 1 / **2** (1.5) | 3 x | 1,000 | 7 |",
            "| 1.23 / **30** (20) | 1.23e-5 x | 12,346 | 7 |"))
        self.assertEqual(self.sut("check", self.page, self.results), 0, self.said)

    def test_writing_twice_is_writing_once(self):
        self.write()
        once = self.page.read_text()
        self.write(page=once)
        self.assertEqual(self.page.read_text(), once)

    def test_figures_that_are_missing_leave_a_dash_or_an_empty_cell(self):
        self.write(rows=[cow("t.p99", None)])
        self.assertIn("| - / none |  |  | 7 |\n", self.page.read_text())

    def test_rounding_is_zero_and_whole_numbers_stay_whole(self):
        self.write(rows=[cow("t.p50", 3e-13), cow("t.p99", 99.96), cow("size", 5.0)])
        self.assertIn("| 0 / 100 |  | 5 | 7 |\n", self.page.read_text())

    def test_a_goal_that_is_met_is_not_bold(self):
        self.write(rows=[cow("t.p50", 1.0, goal=1.5, met=True), cow("t.p99", 2.0)])
        self.assertIn("| 1 (1.5) / 2 |", self.page.read_text())

    def test_a_table_without_rows_stays_and_is_named(self):
        self.assertEqual(self.write(rows=COUNTS), 0)
        self.assertEqual(self.page.read_text(), PAGE)
        self.assertIn("slide; part=A: left: the run has no rows for it", self.said)

    def test_lines_that_the_page_has_not_chosen_stay_out_unless_it_has_none(self):
        lines = PAGE[PAGE.index("| cow"):PAGE.index("\n| not marked")]
        self.assertEqual(self.write(page=PAGE.replace(lines, "")), 0)
        self.assertIn("| --- |\n"
                      "| cow (cow-5804) | ours, K 1 | 1.23 / **30** (20) | 1.23e-5 x | 12,346 |  |\n"
                      "| cow (cow-5804) | ours, K 2 | 9 / - |  |  |  |\n\n", self.page.read_text())

    def test_a_quick_run_never_goes_over_a_full_one(self):
        self.assertEqual(self.write(quick=True), 1)
        self.assertIn("left: it is of a full run", self.said)
        self.assertEqual(self.page.read_text(), PAGE)

    def test_a_quick_run_goes_over_a_quick_one_and_a_full_one_over_both(self):
        page = PAGE.replace("*Full", "*Quick")
        self.assertEqual(self.write(page=page, quick=True), 0)
        self.assertIn("*Quick run of 2026-03-04", self.page.read_text())
        self.assertEqual(self.write(page=page), 0)
        self.assertIn("*Full run of 2026-03-04", self.page.read_text())

    def test_a_suite_that_failed_is_not_written(self):
        self.assertEqual(self.write(failures=["slide cow: wrong answers"]), 1)
        self.assertEqual(self.page.read_text(), PAGE)

    def test_two_rows_for_one_figure_are_refused_and_the_page_stays(self):
        self.assertEqual(self.write(rows=[*ROWS, cow("size", 1.0)]), 2)
        self.assertIn("2 rows have it", self.said)
        self.assertEqual(self.page.read_text(), PAGE)

    # --- counts

    def counts(self, splits, *options):
        """With a program in place of tactus_bench that counts so many splits."""
        bench = self.folder / "bench"
        rows = [row("counts", "one", "frames in all", 5, part="B", unit=""),
                row("counts", "one", "splits", splits, part="B", unit=""), COUNTS[1]]
        self.results.write_text(json.dumps(results(rows)))
        bench.write_text(f'#!/bin/sh\n[ "$4" = --json ] && cp "{self.results}" "$5"\n')
        bench.chmod(0o755)
        return self.sut("counts", self.page, bench, *options)

    def test_counts_must_be_as_written(self):
        self.assertEqual(self.counts(12), 0, self.said)
        self.assertEqual(self.counts(13), 1)
        self.assertIn("one: splits: 13 counted, 12 written", self.said)

    def test_a_case_only_counted_or_only_written_differs(self):
        self.page.write_text(PAGE.replace("| two |", "| three |"))
        self.assertEqual(self.counts(12), 1)
        self.assertIn("two: only counted", self.said)
        self.assertIn("three: only written", self.said)

    def test_counts_are_written_on_demand_and_instructions_stay(self):
        self.assertEqual(self.counts(13, "--write"), 0)
        self.assertEqual(self.page.read_text(), PAGE.replace("| one | 12 |", "| one | 13 |"))

    @unittest.skipUnless("avx2" in pathlib.Path("/proc/cpuinfo").read_text(), "there is no AVX2")
    def test_instructions_may_be_off_by_two_percent(self):
        for total, code in ((50_000, 0), (51_000, 0), (49_000, 0), (51_005, 1), (48_000, 1), (0, 2)):
            valgrind = self.folder / "valgrind"  # In place of the real one.
            valgrind.write_text('#!/bin/sh\nfor word; do case "$word" in --callgrind-out-file=*)\n'
                                f'echo "summary: {total}" >"${{word#*=}}";; esac; done\n')
            valgrind.chmod(0o755)
            with self.subTest(total):
                self.assertEqual(self.counts(12, "--instructions"), code, self.said)
        self.assertEqual(self.counts(12), 0)

    # --- command line

    def test_wrong_usage_and_unreadable_files_are_refused(self):
        for words in (["check", "page.md"], ["write", "page.md", "a", "b"], ["print"],
                      ["check", "page.md", "a", "--write"], ["counts", "a", "b", "--all"], [""]):
            self.assertEqual(self.sut(*words), 3)
        self.assertEqual(self.sut("check", self.page, self.folder / "none.json"), 2)
        self.results.write_text('{"rows": 5}')
        self.assertEqual(self.sut("check", self.page, self.results), 2)


if __name__ == "__main__":
    unittest.main()
