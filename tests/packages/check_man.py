# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""check_man.py PROGRAMS PAGES HEADER: each option of a program's --help, with its range, choices
and default, is in its manual page, and vice versa; so are the calls of tactus.h."""
import pathlib
import re
import subprocess
import sys

programs, pages, header = (pathlib.Path(argument) for argument in sys.argv[1:])
faults = 0


def fault(text):
    global faults
    faults += 1
    print("FAULT:", text)


def options_of_help(*command):
    """Names of an option, joined by a comma -> the numbers of its range and default, or choices."""
    said = subprocess.run([programs / command[0], *command[1:], "--help"], check=True,
                          capture_output=True, text=True).stdout
    found = {}
    for line in said.splitlines():
        option = re.match(r"  (-[\w,-]*)(.*)", line)
        if option:
            kind = re.match(r" (?:U?INT|FLOAT):([\d.e+-]+) \.\. ([\d.e+-]+)(?:=([\d.e+-]+))?",
                            option[2])
            numbers = [float(number) for number in kind.groups() if number] if kind else []
            if option[1] == "--threads":
                numbers = numbers[:2]  # Its default depends on the machine.
            choices = re.match(r" TEXT:\{?(\w[\w-]*(?:[,|]\w[\w-]*)+)", option[2])
            found[option[1]] = numbers + (re.split("[,|]", choices[1]) if choices else [])
    return found


def options_of_page(text):
    """The same for one section of a page: text after each .TP."""
    found = {}
    for tag in re.findall(r"^\.TP\n(.*)$", text, re.MULTILINE):
        plain = re.sub(r"\\f.", "", tag).replace("\\-", "-")
        if plain.startswith("-"):
            names = ",".join(re.match(r"(-[\w-]+(?:, -[\w-]+)*)", plain)[1].split(", "))
            bounds = re.search(r"\(([^)]*)\)$", plain)
            numbers = re.findall(r"(?<![\w.])[\d.]+(?:e[+-]?\d+)?", bounds[1]) if bounds else []
            choices = re.search(r" (\w[\w-]*(?:\|\w[\w-]*)+)", plain)
            found[names] = ([float(number) for number in numbers]
                            + (choices[1].split("|") if choices else []))
    return found


def compare(name, of_help, of_page):
    if not of_help:
        fault(f"{name}: no option was found in --help")
    for option in of_help.keys() - of_page.keys():
        fault(f"{name}: the page lacks {option}")
    for option in of_page.keys() - of_help.keys():
        fault(f"{name}: the page has {option}, --help does not")
    for option in of_help.keys() & of_page.keys():
        if of_help[option] != of_page[option]:
            fault(f"{name} {option}: --help says {of_help[option]}, the page {of_page[option]}")


def sections_of(name):
    parts = re.split(r"^\.SH (.*)\n", (pages / name).read_text(), flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2]))


for program in ("spm_build", "spm_inspect", "spm_publish", "spm_view", "hrtc"):
    sections = sections_of(f"{program}.1")
    own = options_of_page(sections["OPTIONS"])
    compare(program, options_of_help(program), own)
    if program == "hrtc":
        for command in ("doctor", "load"):
            compare(f"hrtc {command}", options_of_help(program, command),
                    options_of_page(sections[f"HRTC {command.upper()}"]))
        # It takes most of hrtc's options, and one more.
        test = own | options_of_page(sections["HRTC DEADLINE\\-TEST"])
        for option in ("virtual-time", "record", "replay", "export", "trace", "histograms"):
            test.pop("--" + option)
        test["--duration"] = test["--duration"][:2] + [60]
        compare("hrtc deadline-test", options_of_help(program, "deadline-test"), test)

code = re.sub(r"/\*.*?\*/|//[^\n]*", "", header.read_text(), flags=re.DOTALL)
calls = set(re.findall(r"\b(tactus_\w+)\(", code))
told = set()
for tag in re.findall(r"^\.TP\n(.*)$", sections_of("tactus.h.3")["DESCRIPTION"], re.MULTILINE):
    told |= set(re.findall(r"tactus_\w+", tag))
for call in calls ^ told:
    fault(f"tactus.h(3): {call} is in one of header and page only")
if len(calls) < 10:
    fault(f"tactus.h: only {len(calls)} calls were found")
sys.exit(faults > 0)
