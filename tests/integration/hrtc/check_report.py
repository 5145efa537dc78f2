#!/usr/bin/python3 -S
# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""check_report.py REPORT [LEFT OP RIGHT]...: compares figures of a JSON report.

LEFT is a key such as answers.exact or pairs.0.tool, or several joined by '+'; its value is the
number, the truth value as 0 or 1, or the size of the list or object. OP is one of == < <= > >=.
RIGHT is a number, or NUMBER*KEY. Prints every comparison that fails; exits 1 then, and 2 if the
report cannot be read.
"""

import json
import math
import operator
import sys

COMPARISONS = {"==": operator.eq, "<": operator.lt, "<=": operator.le, ">": operator.gt,
               ">=": operator.ge}


def refuse(constant):
    """For NaN and Infinity, which JSON does not have."""
    raise ValueError(f"{constant} is no number")


def value_of(report, key):
    value = report
    for name in key.split("."):
        try:
            value = value[int(name) if isinstance(value, list) else name]
        except (LookupError, TypeError, ValueError):
            raise LookupError(f"there is no {key}") from None
    if isinstance(value, str):
        raise LookupError(f"{key} is a text")
    number = float(len(value or ()) if value is None or isinstance(value, (list, dict)) else value)
    if not math.isfinite(number):
        raise LookupError(f"{key} is {number}")
    return number


def fault_of(report, left, comparison, right):
    """What is wrong with LEFT OP RIGHT; none if it holds."""
    try:
        value = sum(value_of(report, key) for key in left.split("+"))
        number, star, key = right.partition("*")
        wanted = float(number) * (value_of(report, key) if star else 1.0)
        if not COMPARISONS[comparison](value, wanted):
            return f"{left} is {value:g}; expected {comparison} {right}"
    except (LookupError, OverflowError, ValueError) as error:
        return f"{left} {comparison} {right}: {error}"
    return None


def main(words):
    if not words or (len(words) - 1) % 3 != 0:
        print("usage: check_report.py REPORT [LEFT OP RIGHT]...")
        return 2
    try:
        with open(words[0], encoding="utf-8") as file:
            report = json.load(file, parse_constant=refuse)
    except (OSError, ValueError):
        print(f"{words[0]} can't be read as JSON")
        return 2
    faults = [fault_of(report, *words[at:at + 3]) for at in range(1, len(words), 3)]
    print("".join(f"{fault}\n" for fault in faults if fault), end="")
    return int(any(faults))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
