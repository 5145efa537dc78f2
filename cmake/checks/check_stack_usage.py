#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""check_stack_usage.py ARCHIVE SU_FOLDER CALLS LIMIT ROOT...

Fails when a call of a ROOT may need more than LIMIT bytes of stack. The bytes of each function come
from the .su files that g++ -fstack-usage left in SU_FOLDER, the calls from the archive's machine
code. What machine code does not name stands in the file CALLS, one rule a line, # begins a comment:

    outside SYMBOL BYTES           a function that the archive does not define
    indirect CALLER -> CALLEE      a call through a pointer, and whom it may reach
    indirect CALLER -> BYTES       the same, reaching something outside
    end FUNCTION                   what this one calls never returns and is not counted

CALLER, CALLEE, FUNCTION and ROOT are shell patterns over demangled names; ' | ' stands between
several. Refused besides depth:
recursion, stack of unbounded size, a call through a pointer that no rule names, a function of
unknown size, and a rule about a call that nothing needs. Machine code of x86-64 only.
"""
import collections
import fnmatch
import os
import re
import subprocess
import sys

SYMBOL = re.compile(r'^[0-9a-f]+ <(.+)>:$')
INSTRUCTION = re.compile(r'^ *([0-9a-f]+):\t(?:notrack |bnd )?(\w+) +(.*)$')
RELOCATION = re.compile(r'^\t+[0-9a-f]+: R_X86_64_(\w+)\t(.+?)([+-]0x[0-9a-f]+)?$')
MEMBER = re.compile(r'^(\S+\.o): +file format')


def matches(name, patterns):
    return any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns.split(' | '))


class Refusal(Exception):
    """Why the check can't be made at all."""


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def demangle(names):
    names = list(names)
    text = subprocess.run(['c++filt'], input='\n'.join(names), check=True, capture_output=True,
                          text=True).stdout
    return dict(zip(names, text.split('\n')))


def simple_name(text):
    """The last two parts of a function's name, without types, parameters and template arguments.

    g++ and c++filt print names differently; of lambdas and of what is anonymous both only say so.
    """
    text = re.sub(r' \[with .*|\[clone .*|\[abi:.*?\]', '', text)
    text = re.sub(r'\{anonymous\}|\(anonymous namespace\)', 'anonymous', text)
    text = re.sub(r'<lambda\(.*?\)>|\{lambda\(.*?\)#\d+\}::operator\(\)', 'lambda', text)
    text = re.sub(r'operator\(\)', 'operator_call', text)
    text = re.sub(r'operator(<=>|<<|>>|<=|>=|->|<|>)',
                  lambda match: 'operator_' + '_'.join(str(ord(c)) for c in match[1]), text)
    previous = None
    while previous != text:
        previous, text = text, re.sub(r'<[^<>]*>', '', text)
    qualified = (text.split('(')[0].split() or [''])[-1]
    return '::'.join(qualified.lstrip('*&').split('::')[-2:])


def stem(path):
    """frame.cpp of rt_core/frame/frame.cpp.o: objects and .su files share it."""
    return os.path.basename(path).rsplit('.', 1)[0]


def name_in_source(path, line):
    """g++ writes a clone's suffix in place of its name, which then stands where it is defined."""
    with open(path, encoding='utf-8') as lines:
        text = lines.readlines()[int(line) - 1]
    return simple_name(text.split('(')[0] + '(')


def read_stack_usage(folder):
    """(object, simple name) -> bytes, the most where several share it; None where unbounded."""
    usage = {}
    for place, _, files in os.walk(folder):
        for name in files:
            if not name.endswith('.su'):
                continue
            with open(os.path.join(place, name), encoding='utf-8') as lines:
                for line in lines:
                    where, size, kind = line.rstrip('\n').split('\t')
                    path, row, _, function = where.split(':', 3)
                    simple = simple_name(function)
                    if simple in ('constprop', 'isra', 'part'):
                        simple = name_in_source(path, row)
                    key = (stem(name), simple)
                    known = usage.get(key, 0)
                    bounded = kind in ('static', 'dynamic,bounded') and known is not None
                    usage[key] = max(known, int(size)) if bounded else None
    if not usage:
        raise Refusal(f'{folder}: no .su file; was it built with g++ -fstack-usage?')
    return usage


def whole(symbol):
    """The rarely used part of a function runs on the frame of the function."""
    return symbol.removesuffix('.cold')


def read_functions(archive):
    """All (object, symbol) of code, and of each global one where it is."""
    functions, homes, member = set(), {}, None
    for line in run('nm', '--defined-only', archive).splitlines():
        match = re.match(r'^[0-9a-f]+ (\w) (\S+)$', line)
        if line.endswith('.o:'):
            member = line[:-1]
        elif match and match[1] in 'tTwWuV' and not match[2].endswith('.cold'):
            key = (member, match[2])
            functions.add(key)
            if match[1] != 't':
                homes.setdefault(match[2], key)
    return functions, homes


def read_sections(archive):
    """(object, section) -> sorted (offset, symbol) of the functions in it."""
    sections, member = collections.defaultdict(list), None
    for line in run('objdump', '-t', archive).splitlines():
        match = MEMBER.match(line)
        if match:
            member = match[1]
            continue
        match = re.match(r'^([0-9a-f]+) ......F (\S+)\t[0-9a-f]+ (?:\.hidden )?(\S+)$', line)
        if match:
            sections[member, match[2]].append((int(match[1], 16), match[3]))
    for functions in sections.values():
        functions.sort()
    return sections


class Code:
    """Who calls whom, by (object, symbol)."""

    def __init__(self, archive):
        self.calls = collections.defaultdict(set)
        self.indirect = set()
        self.sections = read_sections(archive)
        self.functions, self.homes = read_functions(archive)
        self.member, self.function, self.pending, self.recent = None, None, None, []
        for line in run('objdump', '-dr', '--no-show-raw-insn', archive).splitlines():
            self.read(line)
        self.settle()

    def read(self, line):
        if match := MEMBER.match(line):
            self.settle()
            self.member = match[1]
        elif match := SYMBOL.match(line):
            self.settle()
            self.function = (self.member, whole(match[1]))
            self.calls[self.function] |= set()
            self.recent = []
        elif match := RELOCATION.match(line):
            if self.pending is not None:
                self.pending = self.target_of(match[2], int(match[3] or '0', 16))
                self.settle()
        elif match := INSTRUCTION.match(line):
            self.settle()
            self.read_instruction(match[2], match[3])

    def read_instruction(self, name, operand):
        is_jump = re.fullmatch(r'jmp|j[a-z]{1,3}', name) is not None
        if (name == 'call' or is_jump) and operand.startswith('*'):
            if name == 'call' or not self.is_jump_table(operand):
                self.indirect.add(self.function)
        elif name == 'call' or is_jump:
            match = re.search(r'<(.+?)(?:\+0x[0-9a-f]+)?>', operand)
            self.pending = match[1] if match else ''
        self.recent = (self.recent + [(name, operand)])[-12:]

    def is_jump_table(self, operand):
        """A switch: the address comes from a table of offsets, scaled by four, or of addresses."""
        scaled = any(name == 'movslq' and ',4)' in text for name, text in self.recent)
        return ',8)' in operand or (scaled and self.recent[-1][0] in ('add', 'lea'))

    def target_of(self, symbol, addend):
        if not symbol.startswith('.'):
            return symbol
        functions = self.sections[self.member, symbol]
        found = [name for start, name in functions if start <= addend + 4]
        return found[-1] if found else ''

    def settle(self):
        """Books the call or jump that was read last, now that its relocation is known."""
        target, self.pending = self.pending, None
        if target is None or self.function is None:
            return
        if target == '':
            raise Refusal(f'{self.function[1]} in {self.function[0]}: a jump to nowhere known')
        local = (self.member, whole(target))
        callee = local if local in self.functions else self.homes.get(whole(target))
        callee = callee or (None, target)
        if callee != self.function or target == self.function[1] and self.is_recursion():
            self.calls[self.function].add(callee)

    def is_recursion(self):
        return self.recent[-1][0] == 'call'


class Rules:
    def __init__(self, path):
        self.outside, self.indirect, self.ends = {}, [], []
        self.unused = set()
        with open(path, encoding='utf-8') as lines:
            for number, line in enumerate(lines, 1):
                line = line.split('#')[0].strip()
                if line:
                    self.add(line, f'{path}:{number}')

    def add(self, line, where):
        if match := re.fullmatch(r'outside (\S+) (\d+)', line):
            self.outside[match[1]] = int(match[2])
            return
        self.unused.add(line)
        if match := re.fullmatch(r'indirect (.+) -> (.+)', line):
            self.indirect.append((match[1], match[2], line))
        elif match := re.fullmatch(r'end (.+)', line):
            self.ends.append((match[1], line))
        else:
            raise Refusal(f'{where}: not a rule: {line}')

    def use(self, line):
        self.unused.discard(line)


class Walk:
    """The deepest chain below each function, found once."""

    def __init__(self, code, usage, rules):
        self.code, self.usage, self.rules = code, usage, rules
        functions = set(code.calls) | {c for calls in code.calls.values() for c in calls}
        demangled = demangle(symbol for _, symbol in functions)
        self.names = {key: demangled[key[1]] for key in functions}
        self.deepest = {}
        self.active = []
        self.faults = []

    def bytes_of(self, key):
        if key[0] is None:
            if key[1] not in self.rules.outside:
                self.fault(f'{key[1]}: outside of the archive, and no rule tells its stack')
                return 0
            return self.rules.outside[key[1]]
        place = (stem(key[0]), simple_name(self.names[key]))
        if place not in self.usage: # A clone: without its namespace.
            place = (place[0], place[1].split('::')[-1])
        if self.usage.get(place, None) is None:
            unknown = 'has no bound' if place in self.usage else 'stands in no .su file'
            self.fault(f'{self.names[key]}: its stack {unknown}')
            return 0
        return self.usage[place]

    def fault(self, text):
        if text not in self.faults:
            self.faults.append(text)

    def targets_of(self, key):
        """Calls of a function, and the bytes of the largest thing outside that it reaches."""
        for pattern, line in self.rules.ends:
            if matches(self.names[key], pattern):
                self.rules.use(line)
                return [], 0
        targets, most = set(self.code.calls.get(key, ())), 0
        rules = [r for r in self.rules.indirect if matches(self.names[key], r[0])]
        if key in self.code.indirect and not rules:
            self.fault(f'{self.names[key]}: calls through a pointer, and no rule tells whom')
        for _, callee, line in rules if key in self.code.indirect else ():
            self.rules.use(line)
            if callee.isdigit():
                most = max(most, int(callee))
                continue
            for one in callee.split(' | '):
                reached = {k for k, n in self.names.items() if k[0] and matches(n, one)}
                if not reached:
                    self.fault(f'no function matches {one} (called by {self.names[key]})')
                targets |= reached
        return sorted(targets, key=str), most

    def depth(self, key):
        """(bytes, chain) of the deepest way down from here, itself included."""
        if key in self.deepest:
            return self.deepest[key]
        if key in self.active:
            ring = self.active[self.active.index(key):] + [key]
            self.fault('recursion: ' + ' -> '.join(self.names[k] for k in ring))
            return (0, [])
        self.active.append(key)
        targets, most = self.targets_of(key)
        below = (most, [('what is called through a pointer', most)] if most else [])
        for target in targets:
            below = max(below, self.depth(target), key=lambda way: way[0])
        self.active.pop()
        own = self.bytes_of(key)
        self.deepest[key] = (own + below[0], [(self.names[key], own)] + below[1])
        return self.deepest[key]


def check(archive, folder, calls, limit, roots):
    walk = Walk(Code(archive), read_stack_usage(folder), Rules(calls))
    for root in roots:
        found = [k for k, n in walk.names.items() if k[0] and matches(n, root)]
        if not found:
            raise Refusal(f'{archive}: no function matches {root}')
        size, chain = max((walk.depth(key) for key in found), key=lambda way: way[0])
        print(f'{root}: {size} bytes of at most {limit}, deepest chain:')
        for name, own in chain:
            print(f'  {own:6d}  {name}')
        if size > limit:
            walk.fault(f'{root}: needs {size} bytes, more than {limit}')
    for line in sorted(walk.rules.unused):
        walk.fault(f'{calls}: nothing needs the rule: {line}')
    for fault in walk.faults:
        print(f'FAULT: {fault}')
    return 1 if walk.faults else 0


def main(arguments):
    if len(arguments) < 5 or not arguments[3].isdigit():
        print(__doc__.strip().splitlines()[0], file=sys.stderr)
        return 3
    try:
        return check(arguments[0], arguments[1], arguments[2], int(arguments[3]), arguments[4:])
    except (Refusal, OSError, subprocess.CalledProcessError) as refusal:
        print(f'check_stack_usage.py: {refusal}', file=sys.stderr)
        return 3


if __name__ == '__main__':
    sys.setrecursionlimit(10_000)
    sys.exit(main(sys.argv[1:]))
