# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""check_report.py on reports and comparisons that hold, that fail, and that are none."""

import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = pathlib.Path(__file__).with_name("check_report.py")
REPORT = '{"a": {"b": 2.5}, "list": [{"n": 7}, {}], "yes": true, "none": null, "text": "3"}'


class CheckReport(unittest.TestCase):
    def run_on(self, text, *words):
        """Exit code and output of the program for a report of this text."""
        with tempfile.TemporaryDirectory() as folder:
            report = pathlib.Path(folder, "run.json")
            report.write_text(text, encoding="utf-8")
            done = subprocess.run([PROGRAM, report, *words], capture_output=True, text=True,
                                  check=False)
        return done.returncode, done.stdout

    def test_what_holds_is_silent(self):
        self.assertEqual(self.run_on(REPORT), (0, ""))
        words = ("a.b == 2.5 a.b <= 2.5 a.b >= 2.5 a.b < 2.6 a.b > 2.4 list == 2 list.0.n == 7 "
                 "yes == 1 none == 0 a.b+list.0.n == 9.5 list.0.n == 2.8*a.b")
        self.assertEqual(self.run_on(REPORT, *words.split()), (0, ""))

    def test_each_comparison_can_fail(self):
        for words, line in (("a.b == 2", "a.b is 2.5; expected == 2\n"),
                            ("a.b < 2.5", "a.b is 2.5; expected < 2.5\n"),
                            ("a.b > 2.5", "a.b is 2.5; expected > 2.5\n"),
                            ("a.b <= 2.4", "a.b is 2.5; expected <= 2.4\n"),
                            ("a.b >= 2.6", "a.b is 2.5; expected >= 2.6\n"),
                            ("yes == 0", "yes is 1; expected == 0\n"),
                            ("list.0.n == 2*a.b", "list.0.n is 7; expected == 2*a.b\n"),
                            ("c == 0", "c == 0: there is no c\n"),
                            ("list.2.n == 0", "list.2.n == 0: there is no list.2.n\n"),
                            ("text == 3", "text == 3: text is a text\n"),
                            ("a.b == 1*c", "a.b == 1*c: there is no c\n")):
            self.assertEqual(self.run_on(REPORT, *words.split()), (1, line), words)
            self.assertEqual(self.run_on(REPORT, "yes", "==", "1", *words.split()), (1, line))

    def test_no_number_is_refused(self):
        for constant in ("NaN", "Infinity", "-Infinity"):
            self.assertEqual(self.run_on(f'{{"a": {constant}}}')[0], 2, constant)
        self.assertEqual(self.run_on('{"a": 1e999}', "a", ">", "0")[0], 1)
        for text in ("", "{", '{"a": 1} rest'):
            self.assertEqual(self.run_on(text)[0], 2, text)
        self.assertEqual(self.run_on(REPORT, "a.b", "==")[0], 2)


if __name__ == "__main__":
    unittest.main()
