# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""man_pages.py PROGRAMS PAGES HEADER [--write]: the options in the manual pages are those of each
program's --help, and tactus.h(3) has each call of the header. --write puts the options there."""
import pathlib
import re
import subprocess
import sys
import textwrap

COLUMN = 30  # First column of the descriptions in --help.
MARK = ".\\\" From --help."  # Line before the options in a section of a page.
COMMANDS = {"hrtc": ("doctor", "load"), "tactus": ("touch",)}  # Each with a section of its own.
HEAD = re.compile(r"  (?P<name>-[\w,-]+|[A-Z]+)(?P<kind>(?: (?:TEXT|FLOAT|U?INT)(?::\S+(?: \.\. \S+)?)?)?"
                  r"(?: \.\.\.)?)(?P<rules>(?: REQUIRED)?(?: Needs:(?: -[\w-]+)+)?"
                  r"(?: Excludes:(?: (?:-[\w-]+|[A-Z]+\b))+)?)(?: +(?P<text>\S.*))?$")


def help_of(programs, *command):
    return subprocess.run([programs / command[0], *command[1:], "--help"], check=True,
                          capture_output=True, text=True).stdout


def groups_of(text):
    """Heading of a group of options -> (example, [[name, kind, rules, description]])."""
    groups = {}
    options = None
    for line in text.splitlines():
        heading = re.match(r"(\w[^:]*?)(?:, as in  (.*))?:$", line)
        if heading:
            options = []
            groups[heading[1]] = (heading[2], options)
        elif options is not None and line[:3].strip():
            head = HEAD.match(line)
            if not head:
                break  # The footer.
            options.append([head["name"], head["kind"], head["rules"], head["text"] or ""])
        elif options and line[:COLUMN].strip() == "" and line.strip():
            options[-1][3] = f"{options[-1][3]} {line.strip()}".strip()
    return groups


def roff(text):
    return text.replace("\\", "\\\\").replace("-", "\\-")


def paragraph(text):
    lines = textwrap.wrap(text, 95, break_long_words=False, break_on_hyphens=False)
    return ["\\&" + roff(line) if line[0] in ".'" else roff(line) for line in lines]


def kind_of(kind):
    """Type of a value in the page: its choices, or its name and range."""
    kind, more = re.fullmatch(r"(.*?)( \.\.\.)?", kind).groups()
    choices = re.fullmatch(r" TEXT:\{?([\w-]+(?:[,|][\w-]+)+)\}?", kind)
    if choices:
        return " " + "|".join(f"\\fB{roff(name)}\\fR" for name in re.split("[,|]", choices[1]))
    number = re.fullmatch(r" (\w+):(\S+) \.\. (\S+)", kind)
    if number:
        return f" \\fI{number[1]}\\fR ({roff(number[2])} to {roff(number[3])})"
    return f" \\fI{roff(kind[1:])}\\fR{' ...' if more else ''}" if kind else ""


def rules_of(rules):
    """Sentences on the other options that an option needs or excludes."""
    said = " Required." if "REQUIRED" in rules else ""
    for word, sentence in (("Needs", "Needs"), ("Excludes", "Not with")):
        others = re.search(word + r":((?: [\w-]+)+?)(?= \w+:|$)", rules)
        said += f" {sentence} {', '.join(others[1].split())}." if others else ""
    return said


def page_of(options):
    for name, kind, rules, text in options:
        names = ", ".join(f"\\f{'B' if one.startswith('-') else 'I'}{roff(one)}\\fR"
                          for one in name.split(","))
        default = re.search(r" ?\[default: (.*)\]$", text)
        plain = text[:default.start()] if default else text
        plain += "." if plain and plain[-1] != "." else ""
        last = f" Default: {default[1]}." if default else ""
        yield from [".TP", names + kind_of(kind), *paragraph(plain + rules_of(rules) + last)]


def options_page(groups):
    lines = []
    for heading, (example, options) in groups.items():
        if example:
            lines += [f".SS {heading}", f"Example: \\fB{roff(example)}\\fR"]
        lines += page_of(options)
    return "\n".join(lines) + "\n"


def beside(groups, others):
    """Options of `groups` that `others` lack, and the names that are in `others` alone."""
    known = {option[0] for _, options in others.values() for option in options}
    own = {option[0]: option for _, options in groups.values() for option in options}
    return [option for name, option in own.items() if name not in known], known - own.keys()


def replaced(page, section, body):
    """The page with other options behind the mark in this section."""
    found = re.search(rf"^\.SH {re.escape(section)}\n(?:(?!\.SH ).*\n)*?{re.escape(MARK)}\n"
                      r"((?:(?!\.SH ).*\n)*)", page, re.MULTILINE)
    if not found:
        raise SystemExit(f"{section}: there is no line {MARK}")
    return page[:found.start(1)] + body + page[found.end():]


def written(programs, name, page):
    groups = groups_of(help_of(programs, name))
    page = replaced(page, "OPTIONS", options_page(groups))
    for command in COMMANDS.get(name, ()):
        page = replaced(page, f"{name.upper()} {command.upper()}",
                        options_page(groups_of(help_of(programs, name, command))))
    if name == "hrtc":
        own, missing = beside(groups_of(help_of(programs, name, "deadline-test")), groups)
        names = ", ".join(sorted(option.rsplit(",", 1)[-1] for option in missing if "-" in option))
        body = paragraph(f"It has the options above, except {names}, and:")
        page = replaced(page, "HRTC DEADLINE\\-TEST",
                        "\n".join([".PP", *body, *page_of(own)]) + "\n")
    return page


def faults_of_header(header, page):
    code = re.sub(r"/\*.*?\*/|//[^\n]*", "", header.read_text(), flags=re.DOTALL)
    calls = set(re.findall(r"\b(tactus_\w+)\(", code))
    description = re.search(r"^\.SH DESCRIPTION\n(.*?)(?=^\.SH )", page, re.M | re.S)[1]
    named = {call for tag in re.findall(r"^\.TP\n(.*)$", description, re.MULTILINE)
             for call in re.findall(r"tactus_\w+", tag)}
    if len(calls) < 10:
        yield f"tactus.h: only {len(calls)} calls were found"
    for call in sorted(calls ^ named):
        yield f"tactus.h(3): {call} is in one of header and page only"


def main(arguments):
    programs, pages, header = (pathlib.Path(argument) for argument in arguments[:3])
    faults = list(faults_of_header(header, (pages / "tactus.h.3").read_text()))
    for name in ("spm_build", "spm_inspect", "spm_publish", "spm_view", "tactus", "tactus-keys",
                 "hrtc"):
        path = pages / f"{name}.1"
        page = written(programs, name, path.read_text())
        if page.count("\n.TP\n\\fB") < 5:
            faults.append(f"{name}: hardly any option was found in --help")
        elif arguments[3:] == ["--write"]:
            path.write_text(page)
        elif page != path.read_text():
            faults.append(f"{path.name}: has other options than --help; man_pages.py --write")
    print("\n".join(faults))
    return 1 if faults else 0


sys.exit(main(sys.argv[1:]))
