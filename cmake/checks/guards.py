#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""guards.py ROOT [--only NAME ... | --map]: the guards over the text of the checkout ROOT.

Reads each file once and prints each fault as file:line: text. Exit codes: 0 no fault, 1 a fault,
2 a file that cannot be read or understood, 3 wrong usage.
"""
import argparse
import fnmatch
import functools
import os
import re
import subprocess
import sys

CPP = ('*.hpp', '*.cpp', '*.h', '*.c', '*.idl')
SCRIPTS = ('*.cmake', '*CMakeLists.txt', '*.sh', '.ci/run')
PRODUCT = ('rt_core', 'transport', 'platform', 'host_tools')
LAYERS = 'cmake/layers.cmake'


class Refusal(Exception):
    """The reason why the guards cannot judge the tree."""


class Tree:
    """The project's files below a root, by their paths from it."""

    def __init__(self, root):
        self.root = root
        self.paths = sorted(p for p in self.listed() or self.walked() if os.path.isfile(self.at(p)))

    def at(self, path):
        return os.path.join(self.root, path)

    def exists(self, path):
        return os.path.exists(self.at(path))

    def listed(self):
        """Tracked and new files that git does not ignore; none where git does not know the tree."""
        if not self.exists('.git'):
            return []
        command = ('git', '-C', self.root, 'ls-files', '-z', '--cached', '--others',
                   '--exclude-standard')
        try:
            names = subprocess.run(command, check=True, capture_output=True).stdout
        except (OSError, subprocess.CalledProcessError):
            return []
        return {os.fsdecode(name) for name in names.split(b'\0') if name}

    def walked(self):
        """Every file outside of build folders."""
        for folder, folders, names in os.walk(self.root):
            if folder == self.root:
                folders[:] = [f for f in folders if f != '.git' and not f.startswith('build')]
            yield from (os.path.relpath(os.path.join(folder, name), self.root) for name in names)

    def files(self, *globs):
        """The paths that match one of the globs, whose * also matches a slash."""
        pattern = re.compile('|'.join(map(fnmatch.translate, globs)))
        return [path for path in self.paths if pattern.match(path)]

    @functools.cache
    def text(self, path):
        """The text of a file; empty for a binary file."""
        with open(self.at(path), 'rb') as file:
            content = file.read()
        return '' if b'\0' in content else content.decode('utf-8', 'replace')

    def code(self, path):
        """The text of a CMake file without its comments."""
        return re.sub('#.*', '', self.text(path))

    def matches(self, pattern, paths):
        """(path, line, match) for each match of the pattern, line by line."""
        pattern = re.compile(pattern, re.MULTILINE)
        for path in paths:
            text = self.text(path)
            for match in pattern.finditer(text):
                yield path, text.count('\n', 0, match.start()) + 1, match

    def prose(self, page):
        """(line, text) of a page, code blocks left out."""
        is_code = False
        for number, line in enumerate(self.text(page).split('\n'), 1):
            if re.match(' *```', line):
                is_code = not is_code
            elif not is_code:
                yield number, line


def is_within(path, bases):
    """Whether the path is one of the bases or is below one."""
    return any(base in ('*', path) or path.startswith(base + '/') for base in bases)


class Layers:
    """The table of cmake/layers.cmake. Of CMake it may use the commands of the table below, with
    words, lists and comments; anything else is refused."""

    def __init__(self, tree):
        self.modules, self.external, self.lists = {}, {}, {}
        tables = {'tactus_module': self.modules, 'tactus_external': self.external,
                  'set': self.lists}
        if not tree.exists(LAYERS):
            raise Refusal(f'{LAYERS}: is not there')
        text = tree.code(LAYERS)
        for command in re.finditer(r'([a-z_]+)\(([^()]*)\)|\S.*', text):
            table = tables.get(command[1])
            words = self.expanded(command[2] or '')
            if table is None or not words or words[0] in table:
                line = text.count('\n', 0, command.start()) + 1
                fault = 'has a name again' if table and words else 'is not understood'
                raise Refusal(f'{LAYERS}:{line}: {fault}: ' + command[0].split('\n')[0])
            table[words[0]] = words[1:]
        if 'TACTUS_RT_CORE_STANDARD_HEADERS' not in self.lists:
            raise Refusal(f'{LAYERS}: does not set TACTUS_RT_CORE_STANDARD_HEADERS')

    def expanded(self, text):
        """The words of a command, lists replaced by their own; none when one is not understood."""
        words = []
        for word in text.split():
            name = re.fullmatch(r'\$\{(\w+)\}', word)
            if name and name[1] in self.lists:
                words += self.lists[name[1]]
            elif re.fullmatch(r'[\w./*+-]+', word):
                words.append(word)
            else:
                return []
        return words

    @functools.cache
    def module_of(self, path):
        """The module with the longest path that holds the path; empty when there is none."""
        return max((module for module in self.modules if is_within(path, [module])), key=len, default='')

    def objection_to(self, file, header, is_quoted):
        """Why the file may not include the header; empty when it may."""
        module = self.module_of(file)
        first = header.split('/')[0]
        if first in self.external:
            if not is_within(file, self.external[first]):
                return f'only these may include {first}: {" ".join(self.external[first])}'
        elif is_quoted:
            target = self.module_of(header)
            # Types generated from IDL have no folder; like DDS itself they stay in transport/dds.
            is_generated = header == first and is_within(file, ('transport/dds', 'tests'))
            if not target and not is_generated:
                return 'not a path of a module from the repository root'
            if target and target != module and not is_within(target, self.modules[module]):
                return f'{module} may include: {" ".join([module, *self.modules[module]])}'
        elif module.startswith('rt_core'):
            standard = self.lists['TACTUS_RT_CORE_STANDARD_HEADERS']
            if header not in standard:
                return f'rt_core may include: {" ".join(standard)}'
        return ''


# Each guard yields its faults as (path, line, text).

INCLUDE = r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"\n]+)[>"]'


def layers(tree):
    """Every #include follows cmake/layers.cmake, and no modules include each other in a circle."""
    table = Layers(tree)
    files = tree.files(*(f'{top}/*.{end}' for top in (*PRODUCT, 'tests')
                         for end in ('hpp', 'cpp', 'h', 'c')))
    for path in files:
        if not table.module_of(path):
            yield path, 1, f'in no module; give its folder a line in {LAYERS}'
    count = 0
    for path, line, match in tree.matches(INCLUDE, filter(table.module_of, files)):
        count += 1
        if objection := table.objection_to(path, match[2], match[1] == '"'):
            yield path, line, f"includes '{match[2]}'; {objection}"
    if not count:
        yield LAYERS, 1, 'no file of a module has an #include'
    arrows = arrows_of(tree, table)
    if circle := circle_of(arrows):
        yield *arrows[circle[0]][circle[1]], 'closes a circle: ' + ' -> '.join(circle)


def arrows_of(tree, table):
    """From module to module of the product: the first #include that makes the arrow."""
    arrows = {module: {} for module in table.modules if not module.startswith('tests')}
    files = tree.files(*(f'{top}/*.{end}' for top in PRODUCT for end in ('hpp', 'cpp', 'h', 'c')))
    for path, line, match in tree.matches(INCLUDE, filter(table.module_of, files)):
        target = table.module_of(match[2]) if match[1] == '"' else ''
        if target and target != table.module_of(path):
            arrows[table.module_of(path)].setdefault(target, (path, line))
    return arrows


def circle_of(arrows):
    """The modules of a circle, the first one again at the end; none where no arrow goes back."""
    done, way = set(), []

    def search(module):
        if module in way:
            return [*way[way.index(module):], module]
        if module in done:
            return []
        way.append(module)
        found = next(filter(None, map(search, sorted(arrows.get(module, ())))), [])
        done.add(way.pop())
        return found

    return next(filter(None, map(search, sorted(arrows))), [])


def map_of(tree):
    """The folders that are modules, in lines: each includes modules of the lines above alone."""
    table = Layers(tree)
    arrows = arrows_of(tree, table)
    if circle_of(arrows):
        raise Refusal('modules include each other in a circle')

    @functools.cache
    def line_of(module):
        return 1 + max(map(line_of, arrows[module]), default=-1)

    lines = {}
    for module in sorted(module for module in arrows if '.' not in module):
        lines.setdefault(line_of(module), []).append(module)
    return [' '.join(modules) for _, modules in sorted(lines.items())]


def module_map(tree):
    """docs/architecture.md draws the modules as they include each other."""
    page = 'docs/architecture.md'
    if tree.exists(page) and '\n'.join(['```text', *map_of(tree), '```']) not in tree.text(page):
        yield page, 1, "its map of the modules is another than 'guards.py . --map' prints"


def modules_told(tree):
    """A comment right above a module's line in cmake/layers.cmake says what lives there."""
    for path, line, match in tree.matches(r'(^#.*\n)?^tactus_module\(([^ )\n]+)',
                                          tree.files(LAYERS)):
        if not match[1] or match[1].startswith('# ---'):
            line += 1 if match[1] else 0
            yield path, line, f'no comment right above says what lives in {match[2]}'


def line_length(tree):
    """A line has at most 100 columns. A column is a character, not a byte. Frame, which orders stages
    and nothing else, has at most 400 lines."""
    for path, line, match in tree.matches('^.{101,}', tree.files(*CPP, *SCRIPTS)):
        yield path, line, f'{len(match[0])} columns; at most 100'
    frame = tree.files('rt_core/frame/frame.?pp')
    if (lines := sum(tree.text(path).count('\n') for path in frame)) > 400:
        yield frame[0], 1, f'{lines} lines with its header; at most 400: other classes do the work'


BACKWARDS = r'///<? *(Of|By|As|And|Likewise|Else|Than)\b'
VAGUE = r'\b(whoever|whatever|nobody|lately|anew|for ever|mend|foretell|seldom|askew)\b'


def plain_comments(tree):
    """A comment has a subject and can be read before the declaration. It names what it means, as
    does a page for users."""
    for path, line, match in tree.matches(BACKWARDS, tree.files(*CPP)):
        yield path, line, f'the comment begins with {match[1]}: name its subject first'
    for path, line, match in tree.matches('(?i)//.*' + VAGUE, tree.files(*CPP)):
        yield path, line, f'{match[1]} in a comment: name what is meant'
    for page in Budgets(tree).user_pages(tree):
        for line, text in tree.prose(page):
            for word in re.findall(VAGUE, text, re.IGNORECASE):
                yield page, line, f'{word}: name what is meant'


def old_names(tree):
    """No name of docs/internals/renamed.tsv is used, where it can't be a word of English."""
    table = 'docs/internals/renamed.tsv'
    refusals = 'tests/unit/hrtc/wrong_usages.txt'
    if not tree.exists(table):
        return
    names = {row.split('\t')[1] for row in tree.text(table).splitlines()[1:]
             if row.split('\t')[0] in ('option', 'class', 'metric', 'C, Python')}
    names = [name for name in names if re.fullmatch(r'--[a-z-]+|\w+_\w+|[A-Z][a-z]+[A-Z]\w*', name)]
    paths = [path for path in tree.paths if path not in (table, refusals, 'cmake/checks/guards.py') and
             not path.startswith(('docs/internals/decisions/', 'docs/benchmarks/'))]
    pattern = r'(?<![\w-])(' + '|'.join(sorted(names)) + r')(?![\w-])'
    for path, line, match in tree.matches(pattern, paths):
        yield path, line, f'{match[1]} has another name: see {table}'


def no_leftovers(tree):
    """No mark of unfinished work. They are spelt in two parts, so that this file has none."""
    marks = r'\b(TO' r'DO|FIX' r'ME|X' r'XX|HA' r'CK)\b'
    for path, line, match in tree.matches(marks, tree.files(*CPP, *SCRIPTS, '*.md', '*.py')):
        yield path, line, f'{match[0]} marks unfinished work'


def machine_paths(tree):
    """No absolute path of one machine. The same words in a longer path or an address are none."""
    pattern = r'/(?<![A-Za-z0-9_./]/)(?:home|root|work|Users)/'
    for path, line, match in tree.matches(pattern, tree.paths):
        yield path, line, f"a path of one machine: '{match[0]}...'"


def licence(tree):
    """Two lines of licence at the top of C++; one, after the interpreter, in scripts."""
    spdx = 'SPDX-License-Identifier: Apache-2.0'
    for path in tree.files(*CPP):
        if not tree.text(path).startswith(f'// {spdx}\n// Copyright the Tactus authors.\n'):
            yield path, 1, 'does not begin with the two lines of licence'
    for path in tree.files(*SCRIPTS, '*.py'):
        if f'# {spdx}' not in tree.text(path).split('\n', 2)[:2]:
            yield path, 1, 'has no SPDX line at the top'


def files_listed(tree):
    """A source, header or test folder that no CMakeLists.txt above it names is never built or run.

    A path may be listed behind a folder's variable: "${folder}/name".
    """
    lists = tree.files('*CMakeLists.txt')
    listed = {}
    for path in lists:
        words = re.split(r'[\s()"]+', tree.code(path))
        listed[os.path.dirname(path)] = {word[at:] for word in words
                                         for at in (0, *(m.end() for m in re.finditer('/', word)))}
    sources = tree.files(*(f'{top}/*.{end}' for top in PRODUCT for end in ('hpp', 'cpp', 'idl')),
                         'tests/*.cpp')
    for path in sources + [os.path.dirname(path) for path in lists if '/' in path]:
        folder = path
        while folder:
            folder = os.path.dirname(folder)
            if os.path.relpath(path, folder or '.') in listed.get(folder, ()):
                break
        else:
            yield path, 1, 'no CMakeLists.txt above it lists it'


def limits_tested(tree):
    """A constant of rt_core/limits.hpp that no test names, comments aside, is a limit that no test
    reaches. Programs that measure are no tests."""
    limits = 'rt_core/limits.hpp'
    tests = [p for p in tree.files('tests/*/test_*.cpp') if not p.startswith('tests/bench/')]
    named = {name for path in tests
             for name in re.findall(r'\bk[A-Z]\w*', re.sub('//.*', '', tree.text(path)))}
    count = 0
    constant = r'^(?:inline )?constexpr [^;={]*?\b(k[A-Z]\w*)\s*[={]'
    for path, line, match in tree.matches(constant, tree.files(limits)):
        count += 1
        if match[1] not in named:
            yield path, line, f'{match[1]} is named in no tests/*/test_*.cpp'
    if not count:
        yield limits, 1, 'has no constant'


def own_header_first(tree):
    """A header that its own source includes first is compiled by itself there; all others are
    compiled by .ci/run (cmake/rt_flags.cmake)."""
    for path in tree.files(*(f'{top}/*.cpp' for top in PRODUCT)):
        header = path.removesuffix('.cpp') + '.hpp'
        if tree.exists(header):
            _, line, first = next(tree.matches('^#include.*', [path]), (path, 1, ['']))
            if first[0] != f'#include "{header}"':
                yield path, line, f'its own header, {header}, is not the first include'


def threads_told(tree):
    """A header that is installed names, in a comment, the thread that may use it."""
    components = 'cmake/components.cmake'
    pattern = rf'\b(?:{"|".join(PRODUCT)})/[a-z0-9_/]+\.(?:hpp|h)\b'
    text = tree.code(components) if tree.exists(components) else ''
    headers = sorted(set(re.findall(pattern, text)))
    comment = r'(?i)(//|/\*|^ \*).*thread'
    told = {path for path, _, _ in tree.matches(comment, filter(tree.exists, headers))}
    for header in headers:
        if header not in told:
            yield header, 1, 'is installed, and no comment says which thread may use it'
    if not headers:
        yield components, 1, 'installs no header'


def links(tree):
    """A link of a page leads to a file that is there, and to a heading of it; a page of docs/ that
    a source, a script or another page names is there."""
    @functools.cache
    def anchors(page):  # As GitHub makes them.
        lines = tree.prose(page) if os.path.isfile(tree.at(page)) else ()
        headings = (re.match('#+ (.*)', line) for _, line in lines)
        return {re.sub('[^a-z0-9 _-]', '', heading[1].lower()).replace(' ', '-')
                for heading in headings if heading}

    for page in tree.files('*.md'):
        for line, text in tree.prose(page):
            for target in re.findall(r'\]\(([^() :]+)\)', text):
                path, _, anchor = target.partition('#')
                path = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
                if not tree.exists(path) or (anchor and anchor not in anchors(path)):
                    yield page, line, f"a link to '{target}', which is not there"
    named = r'\bdocs/[a-z0-9_/-]+\.(?:md|py|cpp|xml)\b'
    for path, line, match in tree.matches(named, tree.files(*CPP, *SCRIPTS, '*.md', '*.py',
                                                            '*.txt')):
        if not tree.exists(match[0]):
            yield path, line, f"names '{match[0]}', which is not there"


class TestNames:
    """What the tests are called, as their sources and the lists of tests/ have it.

    A test is KIND.NAME in add_test, in one word or as KIND.${...} with the NAME, or the rest of it
    behind a part_${...}, among the words of the same list; or it is the program of a tactus_test or
    a source test_*.cpp, with the suites behind it.
    """

    def __init__(self, tree):
        sources = tree.files('tests/*.cpp', 'tests/*.hpp')
        suite = r'^ *(?:TYPED_|RC_GTEST_)?(?:TEST|PROP|FIXTURE_PROP)[A-Z_]*\(([A-Za-z0-9]+)'
        self.suites = {match[1] for _, _, match in tree.matches(suite, sources)}
        self.programs = set(re.findall(r'/(test_[a-z0-9_]*)\.cpp$', '\n'.join(sources), re.M))
        self.whole = set()
        self.composed = []  # (kinds, beginnings, words) of each list
        for path in tree.files('tests/*CMakeLists.txt'):
            text = tree.code(path)
            self.programs.update(re.findall(r'tactus_(?:test|program)\(([a-z0-9_]+)', text))
            self.whole.update(re.findall(r'\bNAME\s+([a-z_]+\.[a-z0-9_]+)', text))
            self.composed.append((set(re.findall(r'\bNAME\s+([a-z_]+)\.\$', text)),
                                  {'', *re.findall(r'([a-z0-9_]+_)\$\{', text)},
                                  set(re.findall('[a-z0-9_]+', text))))
        self.kinds = {name.split('.')[0] for name in self.whole}.union(
            *(kinds for kinds, _, _ in self.composed))

    def has(self, name):
        kind, _, rest = name.partition('.')
        return name in self.whole or any(
            rest.startswith(beginning) and rest[len(beginning):] in words
            for kinds, beginnings, words in self.composed if kind in kinds
            for beginning in beginnings)


def named_tests(tree):
    """A test that a page names is there."""
    tests = TestNames(tree)
    pattern = r'`(?:(test_[a-z0-9_]+)`((?: [A-Z][A-Za-z0-9]+,?)*)|([a-z_]+)\.[a-z0-9_]+`)'
    for page, line, match in tree.matches(pattern, tree.files('*.md')):
        name = match[0].split('`')[1]
        # A word with a dot in it whose beginning is no kind of test is something else.
        if (name not in tests.programs if match[1]
                else match[3] in tests.kinds and not tests.has(name)):
            yield page, line, f"no test is called '{name}'"
        for suite in (match[2] or '').replace(',', '').split():
            if suite not in tests.suites:
                yield page, line, f"no suite of tests is called '{suite}'"


# --- Pages ---------------------------------------------------------------------------------------

BUDGETS = 'cmake/checks/page_words.txt'
LONGEST_SENTENCE = 35


class Budgets:
    """Table of the pages: path or glob, largest number of words, `user` or `contributor`."""

    def __init__(self, tree):
        self.rows = []  # (line, glob, words, is for users)
        text = tree.text(BUDGETS) if tree.exists(BUDGETS) else ''
        for number, line in enumerate(text.split('\n'), 1):
            row = line.split('#')[0].split()
            if row and (len(row) != 3 or not row[1].isdigit()
                        or row[2] not in ('user', 'contributor')):
                raise Refusal(f'{BUDGETS}:{number}: not PAGE WORDS user|contributor')
            if row:
                self.rows.append((number, row[0], int(row[1]), row[2] == 'user'))

    def row_of(self, page):
        return next((row for row in self.rows if fnmatch.fnmatchcase(page, row[1])), None)

    @staticmethod
    def pages(tree):
        return tree.files('README.md', 'docs/*.md')

    def user_pages(self, tree):
        return [page for page in self.pages(tree) if (row := self.row_of(page)) and row[3]]


def words_in(text):
    """Words of Markdown: a link is its text, code or a formula one word."""
    text = re.sub(r'<!--.*?-->|!?\[([^\]]*)\]\([^()]*\)', r' \1 ', text, flags=re.S)
    text = re.sub(r'`[^`]*`|\$\$.*?\$\$|\$[^$]+\$', 'code', text, flags=re.S)
    return re.findall(r'[^\s|]*\w[^\s|]*', text)


def page_words(tree):
    """A page has at most the words of cmake/checks/page_words.txt, code blocks left out."""
    budgets = Budgets(tree)
    used = set()
    for page in budgets.pages(tree):
        row = budgets.row_of(page)
        if not row:
            yield page, 1, f'has no line in {BUDGETS}'
            continue
        used.add(row[0])
        count = len(words_in('\n'.join(text for _, text in tree.prose(page))))
        if count > row[2]:
            yield page, 1, f'{count} words; at most {row[2]} ({BUDGETS}:{row[0]})'
    for row in budgets.rows:
        if row[0] not in used:
            yield BUDGETS, row[0], f"names '{row[1]}', which is not there"


def paragraphs(tree, page):
    """(line, text) of each paragraph, list item and table cell of a page."""
    began, lines, is_formula = 0, [], False
    for number, line in [*tree.prose(page), (0, '')]:
        text = line.strip()
        if text.count('$$') == 1:
            is_formula = not is_formula
            text = ''
        if is_formula:
            continue
        if line.startswith('    ') and not lines:
            continue  # Code.
        is_new = not text or re.match(r'[#|]|[*+-] |\d+\. |<!--', text)
        if is_new and lines:
            yield began, ' '.join(lines)
            lines = []
        if text.startswith('|'):
            yield from ((number, cell) for cell in re.split(r'(?<!\\)\|', text))
        elif text and not text.startswith(('#', '<!--', '$$')):
            began = began if lines else number
            lines.append(re.sub(r'^([*+-]|\d+\.) +', '', text))


def sentences(tree):
    """A sentence of a page for users has at most 35 words."""
    for page in Budgets(tree).user_pages(tree):
        for line, paragraph in paragraphs(tree, page):
            for sentence in re.split(r'(?<=[.!?])[)*]*\s+(?=[^a-z])', paragraph):
                if (count := len(words_in(sentence))) > LONGEST_SENTENCE:
                    begin = ' '.join(sentence.split()[:6])
                    yield page, line, f"{count} words in '{begin} ...'; at most {LONGEST_SENTENCE}"


def inside_of_users_pages(tree):
    """A page for users names no test, and no file of the sources but cmake/setup.sh."""
    kinds = '|'.join(sorted(TestNames(tree).kinds)) or '(?!)'
    inside = (r'(?<![\w./<-])(?:rt_core|transport|platform|host_tools|tests|cmake)/'
              r'(?!setup\.sh)[\w./*{]+'
              rf'|`test_\w+`|`(?:{kinds})\.\w+`')
    for page in Budgets(tree).user_pages(tree):
        for line, text in tree.prose(page):
            for name in re.findall(inside, text):
                yield page, line, f"names '{name}', which no user of the package has"


def tables(tree):
    """Each row of a table has as many cells as its head, and no row is outside of a table."""
    for page in tree.files('*.md'):
        cells, last = 0, ''
        for line, text in tree.prose(page):
            row = re.sub(r'\\\|', '', text.strip())
            count = row.count('|') - 1
            if not row.startswith('|'):
                cells = 0
            elif re.fullmatch(r'\|( *:?-+:? *\|)+', row):
                cells = count
                if last.count('|') - 1 != cells:
                    yield page, line, f'{cells} columns below a head of {last.count("|") - 1}'
            elif cells and count != cells:
                yield page, line, f'{count} cells in a table of {cells} columns'
            elif not cells and last.startswith('|'):
                yield page, line, 'a row outside of a table; is there a line of dashes above?'
            last = row


# Options of other programs that pages name.
FOREIGN = {
    'adduser': ('groups',), 'apt-get': ('no-install-recommends',),
    'cmake': ('build', 'component', 'fresh', 'install', 'parallel', 'preset', 'prefix', 'target',
              'toolchain', 'workflow'),
    'docker': ('cap-add', 'ulimit'), 'gtest': ('gtest_filter',),
    'pkg-config': ('cflags', 'libs', 'static'), 'systemctl': ('now',),
    'udevadm': ('reload-rules',),
}


def options_named(tree):
    """An option that a page names is one of our programs and scripts, or listed above. Decisions
    tell of options that are gone."""
    option = r'(?<![\w-])--([a-z][a-z0-9_-]*)'
    sources = ('docs/man/*.1', 'cmake/setup.sh', 'cmake/checks/*.py', '.ci/run', 'tests/*.py',
               'tests/*.sh', 'tests/bench/*.cpp', 'docs/site/*.py')
    known = {name for names in FOREIGN.values() for name in names}
    for path in tree.files(*sources):
        known.update(re.findall(r'--([a-z][a-z0-9_-]*)', tree.text(path).replace('\\-', '-')))
    pages = [page for page in Budgets.pages(tree) if '/decisions/' not in page]
    for page, line, match in tree.matches(option, pages):
        if match[1] not in known:
            yield page, line, f"no option is called '--{match[1]}'"


VERSIONS = {  # Row of docs/versions.md: source of its number.
    'Release': ('CMakeLists.txt', r'project\(tactus VERSION (\S+)'),
    'SPM format': ('rt_core/spm/header.hpp', r'kFormatVersion = (\d+)'),
    'SPM coder': ('rt_core/spm/header.hpp', r'kCoderVersion = (\d+)'),
    'DDS protocol': ('transport/dds/topics.hpp', r'kProtocolVersion = (\d+)'),
    'Recording': ('platform/recording/recording_format.hpp', r'kRecordingVersion = (\d+)'),
    'Report': ('platform/report/report.cpp', r'"schema", (\d+)'),
    'UDP devices': ('platform/devices/udp/datagram.hpp', r'kVersion = (\d+)'),
    'C API': ('host_tools/c/tactus.h', r'define TACTUS_ABI (\d+)'),
    'Device plug-in': ('platform/devices/plugin/device_plugin.hpp', r'kPluginLayout\{(\d+)'),
}


def versions_told(tree):
    """docs/versions.md has the versions of all formats and interfaces."""
    page = 'docs/versions.md'
    if not tree.exists(page):
        return
    rows = dict(re.findall(r'^\| \[?([\w -]*\w)[^|]*\| ([\d.]+) \|', tree.text(page), re.M))
    for name, (source, pattern) in VERSIONS.items():
        found = re.search(pattern, tree.text(source)) if tree.exists(source) else None
        if not found or rows.get(name) != found[1]:
            yield page, 1, f"{name} is {rows.get(name, 'missing')}; {source} has " + (
                found[1] if found else 'none')


def glossary_sorted(tree):
    """The words of the glossary are in order."""
    page, before = 'docs/glossary.md', ''
    for _, line, match in tree.matches(r'^\| ([^|]+?) \|', tree.files(page)):
        word = match[1].strip('`*').casefold()
        if word.startswith(('---', 'word', 'term')):
            before = ''
        elif word < before:
            yield page, line, f"'{match[1]}' belongs above '{before}'"
        else:
            before = word


GUARDS = {guard.__name__: guard for guard in (
    layers, modules_told, module_map, line_length, plain_comments, old_names, no_leftovers,
    machine_paths, licence,
    files_listed, limits_tested, own_header_first, threads_told, links, named_tests,
    page_words, sentences, inside_of_users_pages, tables, options_named, versions_told,
    glossary_sorted)}


class Parser(argparse.ArgumentParser):
    def error(self, message):
        print(f'guards.py: {message}; --help shows the usage', file=sys.stderr)
        sys.exit(3)


def main(arguments):
    parser = Parser(prog='guards.py', description='the guards over the text of a checkout',
                    epilog='guards: ' + ' '.join(GUARDS))
    parser.add_argument('root', metavar='ROOT', help='the root of the checkout')
    parser.add_argument('--only', metavar='NAME', nargs='+', choices=GUARDS, default=list(GUARDS),
                        help='the guards to run [default: all]')
    parser.add_argument('--map', action='store_true', help='print the map of the modules instead')
    options = parser.parse_args(arguments)
    try:
        tree = Tree(options.root)
        if 'CMakeLists.txt' not in tree.paths:
            parser.error(f"no CMakeLists.txt in '{options.root}'; is this the checkout?")
        if options.map:
            print('\n'.join(map_of(tree)))
            return 0
        faults = [fault for name in options.only for fault in GUARDS[name](tree)]
    except (Refusal, OSError) as refusal:
        print(f'guards.py: {refusal}', file=sys.stderr)
        return 2
    for path, line, text in faults:
        print(f'{path}:{line}: {text}')
    print(f'{len(tree.paths)} files, guards: {" ".join(options.only)}; faults: {len(faults)}')
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
