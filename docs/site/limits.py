#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""limits.py ROOT [--write]: the table of limits in docs/conventions.md has the values of
rt_core/limits.hpp; --write puts them there.

Exit codes: 0 done, 1 the page has another table, 2 a source is not understood, 3 wrong usage.
"""
import pathlib
import re
import sys

SOURCE, PAGE = 'rt_core/limits.hpp', 'docs/conventions.md'
BEGIN, END = '<!-- limits: docs/site/limits.py --write -->\n\n', '\n<!-- end of the limits -->\n'
NEAREST = 'The nearest are followed; a tool stops where the others could begin'

# (subject, constants from least to largest, unit, effect beyond)
ROWS = (
    ('Tools of a controller', ('kMaxTools',), '', 'Refused'),
    ('Objects of a scene', ('kMaxObjects',), '', 'Refused'),
    ('Models of a scene', ('kMaxModels',), '', 'Refused'),
    ('Active faces of all models', ('kMaxPoolFaces',), '', 'Refused'),
    ('Pairs of a tool and a near object', ('kMaxPairs',), '', NEAREST),
    ('Near objects of a tool', ('kMaxNear',), '', NEAREST),
    ('Exact triangles of a pair', ('kMaxLocalTriangles',), '',
     'The nearest are kept; the certified radius shrinks'),
    ('Contacts of a pair', ('kMaxContacts',), '', 'The nearest are reported'),
    ('Meeting faces of a mesh tool and an object', ('kMaxMeetingFaces',), '',
     'The report is marked truncated'),
    ('Scene changes of a frame', ('kMaxSceneChanges',), '', 'Refused and counted'),
    ('Splits, and merges, of a frame', ('kMaxSplitsPerFrame',), '', 'The next frame continues'),
    ('Proxy steps of a frame', ('kProxySteps',), '', 'The next frame continues'),
    ('Vertices of a convex hull', ('kMaxHullVertices',), '', 'Refused'),
    ('Vertex splits of a model', ('kMaxRecords',), '', 'Refused'),
    ('Faces of a base mesh', ('kMaxBaseFaces',), '', 'Refused'),
    ('Bits of a coordinate', ('kMinPositionBits', 'kMaxPositionBits'), '', 'Refused'),
    ('Coordinates of a mesh, either sign', ('kModelReachMax_m',), ' m', 'Refused'),
    ('Coordinates of a pose, either sign', ('kPoseReachMax_m',), ' m', 'Refused'),
    ('Scale of a pose', ('kPoseScaleMin', 'kPoseScaleMax'), '', 'Refused'),
    ('Coordinates of a device pose, either sign', ('kGoalRange_m',), ' m',
     'The sample is not used'),
    ('Deviation of a rotation from orthonormal', ('kRotationTolerance',), '',
     'The sample is not used; a device frame is refused'),
    ('Width of force shading', ('kShadingWidthMin_m', 'kShadingWidthMax_m'), ' m', 'Refused'),
    ('Age of the last device sample', ('kSampleHold_s',), ' s', 'The force fades'),
    ('Fade of a force to zero', ('kFadeTime_s',), ' s', ''),
    ('Return of a faded force', ('kRiseTime_s',), ' s', ''),
    ('Name of a model, in UTF-8', ('kMaxNameBytes',), ' bytes', 'Refused'),
)


class Refusal(Exception):
    """A source that is not understood."""


def number(expression, known):
    """Value of a constant's expression: numbers, operators and earlier constants."""
    words = re.sub(r"(?<=\d)'(?=\d)", '', expression)
    words = re.sub(r'0x[0-9a-f.]+p-?\d+', lambda hexadecimal: str(float.fromhex(hexadecimal[0])),
                   words)
    words = re.sub(r'\b(\d[\w.]*?)[Uu]\b', r'\1', words)
    if not re.fullmatch(r'[\w\s.+*/()<>-]+', words):
        raise ValueError(words)
    return eval(words, {'__builtins__': {}}, known)  # pylint: disable=eval-used


def constants(text):
    known = {}
    for name, expression in re.findall(r'constexpr [\w:]+ (k\w+) = ([^;]+);', text):
        try:
            known[name] = number(expression, known)
        except (SyntaxError, ValueError, NameError, TypeError) as error:
            raise Refusal(f'{SOURCE}: {name}: {error}') from error
    return known


def shown(value):
    return f'{value:,}' if isinstance(value, int) or value >= 1000 and value == int(value) \
        else f'{value:g}'


def table(known):
    lines = ['| Limit | Value | Beyond it |', '| --- | --- | --- |']
    for subject, names, unit, effect in ROWS:
        if missing := [name for name in names if name not in known]:
            raise Refusal(f'{SOURCE}: there is no {missing[0]}')
        values = ' to '.join(shown(known[name]).removesuffix('.0') for name in names)
        lines.append(f'| {subject} | {values}{unit} | {effect} |'.replace('|  |', '| |'))
    return '\n'.join(lines) + '\n'


def main(arguments):
    if len(arguments) not in (1, 2) or arguments[1:] not in ([], ['--write']):
        print('limits.py: give ROOT and perhaps --write', file=sys.stderr)
        return 3
    root = pathlib.Path(arguments[0])
    try:
        page = (root / PAGE).read_text(encoding='utf-8')
        before, begin, rest = page.partition(BEGIN)
        old, end, after = rest.partition(END)
        if not end:
            raise Refusal(f'{PAGE}: has no marks for the table of limits')
        new = table(constants((root / SOURCE).read_text(encoding='utf-8')))
    except (Refusal, OSError) as error:
        print(f'limits.py: {error}', file=sys.stderr)
        return 2
    if arguments[1:]:
        (root / PAGE).write_text(before + begin + new + end + after, encoding='utf-8')
    elif old != new:
        first = (before + begin).count('\n')
        pairs = enumerate(zip(old.split('\n'), new.split('\n')))
        line = first + 1 + next((at for at, (is_now, wanted) in pairs if is_now != wanted), 0)
        print(f"{PAGE}:{line}: not the limits of {SOURCE}; run 'docs/site/limits.py . --write'")
        return 1
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
