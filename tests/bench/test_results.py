#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""results.py and counts.py as programs: planted faults are detected, and full results stay."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).parent
PAGE = """# Figures
![a picture](benchmarks/slide.svg) in 100 words.

<!-- benchmarks/slide.json -->

| K 5 | time, us |
| --- | --- |
| cow | 1.23, **1,235** (20) |
"""


def row(suite, case, metric, value, **more):
    return {"suite": suite, "case": case, "metric": metric, "value": value, "unit": "us", **more}


ROWS = [row("slide", "cow", "p50", 1.2345), row("slide", "cow", "p99", 1234.9, goal=20, met=False),
        row("counts", "one", "frames in all", 5), row("counts", "one", "splits", 12)]


def results(rows, **more):
    return {"schema": 2, "commit": "abc", "options": [], "quick": False, "compiler": "12",
            "machine": {"kernel": "1", "processor": "CPU", "processors": 2, "date_utc": "2026"},
            "rows": rows, **more}


class Kept(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name)
        self.folder = self.root / "benchmarks"
        self.folder.mkdir()
        self.file = self.folder / "slide.json"
        self.page = self.root / "benchmarks.md"
        (self.folder / "slide.svg").touch()

    def sut(self, script, *words):
        done = subprocess.run([sys.executable, "-B", HERE / script, *words], check=False,
                              capture_output=True, text=True, env=os.environ | {
                                  "PATH": f"{self.root}{os.pathsep}{os.environ['PATH']}"})
        self.said = done.stdout + done.stderr
        return done.returncode

    def store(self, rows=tuple(ROWS), **more):
        run = self.root / "run.json"
        run.write_text(json.dumps(results(list(rows), **more)))
        return self.sut("results.py", "store", self.folder, run)

    def check(self, page=PAGE):
        self.page.write_text(page)
        return self.sut("results.py", "check", self.folder, self.page)

    def test_a_run_is_kept_by_suites_and_told_by_the_page(self):
        self.assertEqual(self.store(), 0, self.said)
        self.assertEqual(json.loads(self.file.read_text()), results(ROWS[:2]))
        self.assertEqual([path.name for path in self.folder.glob("*.json")], ["slide.json"])
        self.assertEqual(self.check(), 0, self.said)

    def test_a_lesser_run_or_one_that_failed_leaves_a_full_one(self):
        self.store()
        full = self.file.read_text()
        for more in ({"options": ["--quick"]}, {"failures": ["slide cow: wrong answers"]}):
            self.assertEqual(self.store(ROWS[:1], **more), 1)
            self.assertEqual(self.file.read_text(), full)

    def test_a_full_run_without_rows_that_are_kept_leaves_them(self):
        instructions = row("slide", "cow", "instructions", 20_000)
        self.store([*ROWS, instructions])
        full = self.file.read_text()
        self.assertEqual(self.store(), 1)
        self.assertIn("1 of its rows are not in these results, the first 'cow instructions'", self.said)
        self.assertEqual(self.file.read_text(), full)
        self.assertEqual(self.store([*ROWS, instructions | {"value": 2}]), 0, self.said)
        self.file.unlink()
        self.assertEqual(self.store(), 0, self.said)

    @unittest.skipUnless(shutil.which("git"), "no git")
    def test_commits_that_the_history_has_not_must_be_told(self):
        def git(*words):
            subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@a", *words], check=True,
                           cwd=self.root, capture_output=True)
        git("init", "-q")
        git("commit", "-q", "--allow-empty", "-m", "first")
        head = subprocess.run(["git", "rev-parse", "HEAD"], cwd=self.root, check=True,
                              capture_output=True, text=True).stdout.strip()
        self.store(commit=head)
        self.assertEqual(self.check(), 0, self.said)
        for remarks, page, faults in (("", "", 2), ("of abc", "", 1), ("", "of abc\n", 1),
                                      ("of abc", "of abc\n", 0)):
            with self.subTest(remarks=remarks, page=page):
                self.store(remarks=remarks)
                self.assertEqual(self.check(PAGE + page), min(faults, 1), self.said)
                self.assertEqual(self.said.count("is not in this history"), faults)

    def test_a_full_run_goes_over_a_lesser_one(self):
        self.store(ROWS[:1], options=["--quick"])
        self.assertEqual(self.store(), 0, self.said)
        self.assertEqual(json.loads(self.file.read_text()), results(ROWS[:2]))

    def test_numbers_and_pictures_that_are_not_kept_are_found(self):
        self.store()
        for old, new in (("1.23,", "1.24,"), ("1,235", "1,234"), ("(20)", "(21)"), ("**1,235**", "1,235"),
                         ("1.23,", "**1.23**,"), ("slide.svg", "other.svg"), ("![a picture]", "")):
            with self.subTest(new):
                self.assertEqual(self.check(PAGE.replace(old, new)), 1)

    def test_pages_of_the_folder_are_checked_too(self):
        self.store()
        more = self.folder / "more.md"
        for text, code in ((PAGE, 0), (PAGE.replace("1.23,", "1.24,"), 1)):
            more.write_text(text.replace("](benchmarks/", "]("))
            self.assertEqual(self.check(PAGE), code, self.said)

    def test_further_pages_are_checked_too(self):
        self.store()
        self.page.write_text(PAGE)
        more = self.root / "README.md"
        for text, code in ((PAGE, 0), (PAGE.replace("1.23,", "1.24,"), 1)):
            more.write_text(text)
            self.assertEqual(self.sut("results.py", "check", self.folder, self.page, more), code,
                             self.said)

    def test_files_of_another_form_are_found(self):
        for change in (lambda kept: kept.pop("commit"), lambda kept: kept["machine"].pop("date_utc"),
                       lambda kept: kept["rows"][0].pop("unit"),
                       lambda kept: kept["rows"][0].update(peer="them"),
                       lambda kept: kept["rows"][0].update(suite="other"),
                       lambda kept: kept["rows"][0].update(value="fast")):
            self.store()
            kept = json.loads(self.file.read_text())
            change(kept)
            self.file.write_text(json.dumps(kept))
            self.assertEqual(self.check("No table, ![a picture](benchmarks/slide.svg)."), 1)

    def test_counts_must_be_as_kept_and_instructions_within_two_percent(self):
        kept, run, bench = (self.root / name for name in ("kept.json", "run.json", "bench"))
        kept.write_text(json.dumps(results([*ROWS[2:], row("counts", "one", "instructions a frame",
                                                           10_000)])))
        bench.write_text(f'#!/bin/sh\n[ "$4" = --json ] && cp "{run}" "$5" || true\n')
        valgrind = self.root / "valgrind"  # Replaces the real one.
        for splits, total, code in ((12, 50_000, 0), (12, 51_000, 0), (12, 51_005, 1),
                                    (12, 48_000, 1), (13, 50_000, 1), (12, 0, 2)):
            run.write_text(json.dumps(results([ROWS[2], ROWS[3] | {"value": splits}])))
            valgrind.write_text('#!/bin/sh\nfor word; do case "$word" in --callgrind-out-file=*)\n'
                                f'echo "summary: {total}" >"${{word#*=}}";; esac; done\n')
            bench.chmod(0o755)
            valgrind.chmod(0o755)
            with self.subTest(splits=splits, total=total):
                self.assertEqual(self.sut("counts.py", kept, bench), splits - 12, self.said)
                self.assertIn(self.sut("counts.py", kept, bench, "--instructions"),
                              (code, 77), self.said)  # 77: no AVX2.
        run.write_text(json.dumps(results(ROWS[2:3])))
        self.assertEqual(self.sut("counts.py", kept, bench), 1)  # A lower count differs too.

    def test_no_frame_costs_more_than_the_worst_that_is_kept(self):
        kept, run, bench = (self.root / name for name in ("worst.json", "run.json", "bench"))
        worst = [row("worst", "box", "most of a frame", 10_000, setting=rate)
                 for rate in ("sunk, 1 kHz", "sunk, 4 kHz")]
        kept.write_text(json.dumps(results([*worst, row("worst", "box", "longest frame", 9)])))
        bench.write_text('#!/bin/sh\n[ "$1 $4 $6" = "worst --json --instructions" ] && '
                         f'cp "{run}" "$5"\n')
        (self.root / "valgrind").touch()
        for path in (bench, self.root / "valgrind"):
            path.chmod(0o755)
        for most, code in ((10_000, 0), (10_200, 0), (10_201, 1), (100, 0)):
            run.write_text(json.dumps(results([worst[0], worst[1] | {"value": most},
                                               row("worst", "box", "longest frame", 10)])))
            with self.subTest(most=most):
                self.assertIn(self.sut("counts.py", kept, bench, "--instructions"), (code, 77),
                              self.said)
        run.write_text(json.dumps(results(worst[:1])))
        self.assertIn(self.sut("counts.py", kept, bench, "--instructions"), (1, 77), self.said)


if __name__ == "__main__":
    unittest.main()
