#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""report_keys.py ROOT [REPORT.json ...]: the tables of docs/report.md have the keys of reports.

Without reports, the names that the sources of the report write; with reports, each of their keys,
and the page has no other one. Keys of a list that is empty in a report are not looked for in it.
Exit codes: 0 done, 1 page and report differ, 2 a file is not readable, 3 wrong usage.
"""
import json
import pathlib
import re
import sys

PAGE = 'docs/report.md'
SOURCES = ('platform/report/report.cpp', 'platform/report/report_events.cpp')
KEY_COLUMNS = ('key', 'flag')
ROOT_SECTION = 'Report format'


class Section:
    """A section of the page: all words in code, and the keys of its tables."""

    def __init__(self):
        self.words, self.keys = set(), []  # keys: (line, key)


def sections(text):
    """Sections of the page by heading; those that explain no key have no keys."""
    found, section, is_table_of_keys = {}, Section(), False
    for number, line in enumerate(text.split('\n'), 1):
        if heading := re.match(r'##? (.+)', line):
            section = found.setdefault(heading[1], Section())
        section.words.update(part for word in re.findall('`([^`]+)`', line)
                             for part in re.split(r'[.\[\]]+', word) if part)
        cells = [cell.strip() for cell in line.split('|')[1:-1]]
        if not cells:
            is_table_of_keys = False
        elif is_table_of_keys:
            section.keys += [(number, key) for key in re.findall('`([^`]+)`', cells[0])]
        else:
            is_table_of_keys = bool({*KEY_COLUMNS} & {*re.split(', ', cells[0])})
    return found


def paths(value, path=''):
    """Paths of all keys in a report, without indices, and whether a container at one has keys."""
    if isinstance(value, list):
        for element in value:
            yield from paths(element, path)
    elif isinstance(value, dict):
        for key, element in value.items():
            below = f'{path}.{key}' if path else key
            yield below, isinstance(element, (dict, list)) and bool(element)
            yield from paths(element, below)


def faults(text, report):
    """(line, fault) of the page's text against a report. A key is in its section, or in that of the
    key before it."""
    found = sections(text)
    top = found.get(ROOT_SECTION, Section())
    seen = dict(sorted(paths(report), key=lambda entry: entry[1]))
    for path in seen:
        first, *rest = path.split('.')
        section = found.get(first)
        if not rest and not section and first not in top.words:
            yield 1, f"has no section and no row for the key '{path}'"
        elif section and not all(
                part in section.words or part in found.get(holder, Section()).words
                for holder, part in zip([first, *rest], rest)):
            yield 1, f"names no key '{path}'"
    for first, section in found.items():
        if section is top:
            yield from ((line, f"no report has the key '{key}'")
                        for line, key in top.keys if key not in seen)
            continue
        if not seen.get(first):
            continue
        for line, name in section.keys:
            key = name.replace('[]', '')
            holder = f'{first}.{key}'.rpartition('.')[0]
            is_seen = any(path.startswith(first + '.') and path.endswith('.' + key)
                          for path in seen)
            if not is_seen and seen.get(holder):
                yield line, f"no report has the key '{first}.{name}'"


def source_names(root):
    """(source, line, name) of each key that the sources write."""
    for source in SOURCES:
        text = (root / source).read_text(encoding='utf-8')
        for match in re.finditer(r'\{"([a-z]\w*)",', text):
            yield source, text.count('\n', 0, match.start()) + 1, match[1]


def main(arguments):
    if not arguments:
        print('report_keys.py: give ROOT and reports', file=sys.stderr)
        return 3
    root, *reports = map(pathlib.Path, arguments)
    try:
        text = (root / PAGE).read_text(encoding='utf-8')
        if reports:
            wrong = [f'{PAGE}:{line}: {fault} ({path})' for path in reports for line, fault in
                     faults(text, json.loads(path.read_text(encoding='utf-8')))]
        else:
            found = sections(text)
            words = set(found).union(*(section.words for section in found.values()))
            wrong = [f"{source}:{line}: {PAGE} has no key '{name}'"
                     for source, line, name in source_names(root) if name not in words]
    except (OSError, ValueError) as error:
        print(f'report_keys.py: {error}', file=sys.stderr)
        return 2
    print(*wrong, sep='\n', end='\n' if wrong else '')
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
