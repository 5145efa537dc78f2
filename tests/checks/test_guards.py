#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Each guard of guards.py passes a small clean tree and names file and line of a planted fault."""
import contextlib
import io
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

CHECKOUT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = CHECKOUT / 'cmake/checks/guards.py'
sys.path.insert(0, str(PROGRAM.parent))
sys.dont_write_bytecode = True
import guards  # noqa: E402

LICENCE = '// SPDX-License-Identifier: Apache-2.0\n// Copyright the Tactus authors.\n\n'
SPDX = '# SPDX-License-Identifier: Apache-2.0\n'


class House(unittest.TestCase):
    """Tree without faults, with the layers of the checkout."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name) / 'house'
        self.build()

    def build(self):
        shutil.rmtree(self.root, ignore_errors=True)
        self.script('CMakeLists.txt', 'add_subdirectory(rt_core)', 'add_subdirectory(tests)')
        self.script('rt_core/CMakeLists.txt', 'add_library(core base/good.hpp limits.hpp)')
        self.script('tests/CMakeLists.txt', 'add_executable(t unit/test_good.cpp)')
        self.script('cmake/components.cmake', 'tactus_component(core PUBLIC rt_core/base/good.hpp)')
        self.source('rt_core/base/good.hpp', '#include <array>', '// Threads: any.')
        self.source('rt_core/limits.hpp', 'inline constexpr int kMaxGood = 1;')
        self.source('tests/unit/test_good.cpp', '#include "rt_core/base/good.hpp"',
                    'static_assert(kMaxGood == 1);')
        # Its comments name pages that the tree does not have.
        self.script(guards.LAYERS, re.sub('#.*', '# A.', (CHECKOUT / guards.LAYERS).read_text()))

    def text(self, path, text):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding='utf-8')

    def source(self, path, *lines):
        """Source whose lines begin at line 4."""
        self.text(path, LICENCE + '\n'.join(lines) + '\n')

    def script(self, path, *lines):
        """Script whose lines begin at line 2."""
        self.text(path, SPDX + '\n'.join(lines) + '\n')

    def run_guards(self, *arguments):
        """(exit code, output) of guards.py."""
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            try:
                code = guards.main([str(argument) for argument in arguments])
            except SystemExit as end:
                code = end.code
        return code, said.getvalue()

    def accept(self, *names):
        code, said = self.run_guards(self.root, '--only', *names)
        self.assertEqual(code, 0, said)

    def refuse(self, name, *faults, code=1):
        """Expects exactly these faults; the tree is clean again afterwards."""
        got, said = self.run_guards(self.root, '--only', name)
        lines = said.splitlines()[:len(faults)]
        self.assertEqual(got, code, said)
        if code == 1:
            self.assertIn(f'faults: {len(faults)}\n', said)
        for fault, line in zip(faults, lines, strict=True):
            self.assertIn(fault, line, said)
        self.build()


class CleanHouse(House):
    def test_every_guard_alone_and_all_together_pass(self):
        for name in guards.GUARDS:
            with self.subTest(name):
                self.accept(name)
        self.assertEqual(self.run_guards(self.root)[0], 0)

    def test_build_folders_are_not_judged(self):
        self.script('build-debug/some.sh', '# TO' 'DO')
        self.script('build/some.sh', '# TO' 'DO')
        self.accept('no_leftovers')
        self.script('rt_core/build/some.sh', '# TO' 'DO')
        self.refuse('no_leftovers', 'rt_core/build/some.sh:2:')

    @unittest.skipUnless(shutil.which('git'), 'needs git')
    def test_of_a_checkout_new_files_are_judged_and_ignored_files_are_not(self):
        subprocess.run(('git', 'init', '-q', self.root), check=True)
        self.text('.gitignore', 'made/\n')
        self.script('made/some.sh', '# TO' 'DO')
        self.accept('no_leftovers')
        self.script('new/some.sh', '# TO' 'DO')
        self.refuse('no_leftovers', 'new/some.sh:2:')


class Usage(House):
    def test_wrong_usage_ends_with_3_and_one_line(self):
        for arguments, text in (((), 'ROOT'), ((self.root, '--only'), '--only'),
                                ((self.root, '--only', 'attic'), "'attic'"),
                                ((self.root, 'attic'), 'attic'),
                                ((self.root / 'nowhere',), 'is this the checkout?'),
                                ((self.root / 'rt_core/base',), 'is this the checkout?')):
            with self.subTest(arguments):
                code, said = self.run_guards(*arguments)
                self.assertEqual((code, said.count('\n')), (3, 1), said)
                self.assertIn(text, said)

    def test_the_program_names_all_faults_of_all_guards(self):
        self.source('rt_core/base/good.hpp', '#include <vector>', '// ' + 'x' * 98)
        ended = subprocess.run((sys.executable, '-B', PROGRAM, self.root), capture_output=True,
                               text=True)
        self.assertEqual(ended.returncode, 1, ended.stderr)
        self.assertEqual([line.split(': ')[0] for line in ended.stdout.splitlines()[:-1]],
                         ['rt_core/base/good.hpp:4', 'rt_core/base/good.hpp:5',
                          'rt_core/base/good.hpp:1'], ended.stdout)


class Layers(House):
    def test_an_include_that_goes_up_or_across_is_refused(self):
        for path, line, fault in (
                ('rt_core/base/good.hpp', '#include "rt_core/math/vec3.hpp"',
                 "includes 'rt_core/math/vec3.hpp'; rt_core/base may include: rt_core/base"),
                ('rt_core/abtree/ab_tree.hpp', '#include "rt_core/forest/forest.hpp"',
                 "includes 'rt_core/forest/forest.hpp'; rt_core/abtree may include: "),
                ('rt_core/math/box.hpp', '  #  include <vector>',
                 "includes 'vector'; rt_core may include: algorithm "),
                ('transport/link.hpp', '#include <dds/dds.h>',
                 "includes 'dds/dds.h'; only these may include dds: transport/dds tests"),
                ('transport/link.hpp', '#include "chunks.h"',
                 "includes 'chunks.h'; not a path of a module from the repository root"),
                ('platform/controller/run.cpp', '#include "platform/report/words.hpp"',
                 "includes 'platform/report/words.hpp'; platform/controller may include: "),
                ('platform/report/words.cpp', '#include "host_tools/mesh/mesh.hpp"',
                 "includes 'host_tools/mesh/mesh.hpp'; platform/report may include: "),
                ('platform/machine/posix/clock.cpp', '#include "platform/hrtc/loop.hpp"',
                 "includes 'platform/hrtc/loop.hpp'; platform/machine may include: ")):
            with self.subTest(path=path, line=line):
                self.source(path, line)
                self.refuse('layers', f'{path}:4: {fault}')

    def test_what_a_module_may_include_passes(self):
        self.source('platform/hrtc/main.cpp', '#include "transport/link.hpp"')
        self.source('transport/dds/link.cpp', '#include "chunks.h"', '#include <dds/dds.h>')
        self.source('transport/link.cpp', '#include <vector>', '#include "transport/link.hpp"')
        self.source('rt_core/frame/frame.hpp', '#include "rt_core/forest/forest.hpp"')
        self.source('tests/unit/rig.hpp', '#include "platform/hrtc/loop.hpp"')
        self.accept('layers')

    def test_a_file_in_no_module_is_refused(self):
        self.source('host_tools/attic/old.hpp', '')
        self.source('rt_core/basement/old.hpp', '')
        self.refuse('layers', 'host_tools/attic/old.hpp:1: in no module',
                    'rt_core/basement/old.hpp:1: in no module')

    def test_modules_in_a_circle_are_refused(self):
        self.source('platform/devices/udp/link.hpp', '#include "platform/devices/dhd/queues.hpp"')
        self.source('platform/devices/dhd/queues.hpp', '#include "platform/devices/device.hpp"')
        self.accept('layers')
        self.source('platform/devices/dhd/key.hpp', '#include "platform/devices/udp/link.hpp"')
        self.refuse('layers', 'platform/devices/dhd/key.hpp:4: closes a circle: '
                    'platform/devices/dhd -> platform/devices/udp -> platform/devices/dhd')

    def test_a_module_of_which_nothing_is_said_is_refused(self):
        table = (self.root / guards.LAYERS).read_text()
        self.accept('modules_told')
        line = table.count('\n') + 1
        for above, at in (('', 0), ('# --- A heading.\n', 1), ('# A.\n\n', 2)):
            with self.subTest(above):
                self.text(guards.LAYERS, f'{table}{above}tactus_module(rt_core/attic)\n')
                self.refuse('modules_told', f'{guards.LAYERS}:{line + at}: no comment right above')

    def test_a_map_that_the_includes_do_not_make_is_refused(self):
        self.source('platform/hrtc/main.cpp', '#include "platform/loop/loop.hpp"')
        code, drawn = self.run_guards(self.root, '--map')
        self.assertEqual(code, 0, drawn)
        self.assertIn('platform/loop', drawn.splitlines()[0].split())
        self.assertEqual(drawn.splitlines()[1], 'platform/hrtc')
        self.text('docs/architecture.md', f'```text\n{drawn}```\n')
        self.accept('module_map')
        self.text('docs/architecture.md', f'```text\nrt_core\n{drawn}```\n')
        self.refuse('module_map', "docs/architecture.md:1: its map of the modules is another")

    def test_a_house_without_includes_is_refused(self):
        for path in ('rt_core/base/good.hpp', 'tests/unit/test_good.cpp'):
            self.source(path, '')
        self.refuse('layers', 'cmake/layers.cmake:1: no file of a module has an #include')

    def test_a_table_that_is_not_understood_ends_with_2(self):
        table = (self.root / guards.LAYERS).read_text()
        line = table.count('\n') + 1
        for command, fault in (('macro(tactus_module path)', 'is not understood: macro('),
                               ('tactus_module(tests/unit ${nowhere})', 'is not understood: tactus_'),
                               ('tactus_module(tests/unit "*")', 'is not understood: tactus_'),
                               ('tactus_module()', 'is not understood: tactus_module()'),
                               ('tactus_module(tests/unit', 'is not understood: tactus_module(tests'),
                               ('and so on', 'is not understood: and so on'),
                               ('tactus_module(tests *)', 'has a name again: tactus_module(tests *)')):
            with self.subTest(command):
                self.text(guards.LAYERS, f'{table}{command} # A comment.\n')
                self.refuse('layers', f'{guards.LAYERS}:{line}: {fault}', code=2)
        self.text(guards.LAYERS, 'tactus_module(tests *)\n')
        self.refuse('layers', 'does not set TACTUS_RT_CORE_STANDARD_HEADERS', code=2)
        (self.root / guards.LAYERS).unlink()
        self.refuse('layers', f'{guards.LAYERS}: is not there', code=2)


class Text(House):
    def test_a_line_of_101_columns_is_refused_and_one_of_100_is_not(self):
        self.source('rt_core/base/good.hpp', '// ' + 'x' * 98)
        self.refuse('line_length', 'rt_core/base/good.hpp:4: 101 columns')
        self.script('some.sh', '# ' + 'x' * 99)
        self.refuse('line_length', 'some.sh:2: 101 columns')
        self.source('rt_core/base/good.hpp', '// ' + 'é' * 97)  # 100 columns, 197 bytes
        self.accept('line_length')

    def test_a_frame_of_401_lines_with_its_header_is_refused_and_one_of_400_is_not(self):
        for lines in (200, 201):
            self.source('rt_core/frame/frame.hpp', *['//'] * 197)
            self.source('rt_core/frame/frame.cpp', *['//'] * (lines - 3))
            if lines == 200:
                self.accept('line_length')
        self.refuse('line_length', 'rt_core/frame/frame.cpp:1: 401 lines with its header')

    def test_comments_that_begin_backwards_or_name_nothing_are_refused(self):
        self.source('rt_core/base/good.hpp', 'int a; ///< Of the last frame.', '/// Nobody waits.')
        self.refuse('plain_comments', 'rt_core/base/good.hpp:4: the comment begins with Of',
                    'rt_core/base/good.hpp:5: Nobody in a comment')
        self.source('rt_core/base/good.hpp', 'int a; ///< Value of the last frame.', '// Often.')
        self.accept('plain_comments')
        self.text('README.md', 'One.\nNobody waits, or seldom.\n```\nnobody\n```\n')
        self.accept('plain_comments')
        self.text(guards.BUDGETS, 'README.md 9 user\n')
        self.refuse('plain_comments', 'README.md:2: Nobody: name', 'README.md:2: seldom: name')

    def test_names_that_were_renamed_are_refused(self):
        self.accept('old_names')
        self.text('docs/internals/renamed.tsv', 'kind\told\tnew\noption\t--old\t--new\n'
                  'class\tOldName\tNewName\nclass\tWord\tTerm\nreport key\told_key\tkey\n')
        self.text('page.md', '# A page\n`--old`, `--older`, `--an-old`, old_key, Word\n')
        self.source('rt_core/base/good.hpp', 'OldName a;', 'OldNames b; // of AnOldName')
        self.refuse('old_names', 'page.md:2: --old has another name: see',
                    'rt_core/base/good.hpp:4: OldName has another name: see')
        self.text('page.md', '# A page\n')
        self.source('rt_core/base/good.hpp', 'int a;')
        self.text('tests/unit/hrtc/wrong_usages.txt', '3 | hrtc --old 1\n')
        self.accept('old_names')

    def test_marks_of_unfinished_work_are_refused(self):
        for mark in ('TO' 'DO', 'FIX' 'ME', 'X' 'XX', 'HA' 'CK'):
            self.source('rt_core/base/good.hpp', f'// {mark}: later.', f'// {mark}S')
            self.text('page.md', f'# A page\nand a {mark}\n')
            self.refuse('no_leftovers', 'page.md:2: ' + mark, 'rt_core/base/good.hpp:4: ' + mark)

    def test_paths_of_one_machine_are_refused_in_every_text_file(self):
        for path in ('/ho' 'me/me/notes.txt', '/ro' 'ot/x', '/wo' 'rk/x', '/Us' 'ers/me/x'):
            self.source('rt_core/base/good.hpp', f'// see {path}', f'// see a{path} or x.org{path}')
            self.text('some.json', f'"{path}"')
            self.text('some.bin', f'\0 {path}')
            self.refuse('machine_paths', 'rt_core/base/good.hpp:4:', 'some.json:1:')

    def test_a_file_without_licence_is_refused(self):
        self.text('rt_core/base/good.hpp', '#pragma once\n')
        self.text('rt_core/base/good.cpp', LICENCE.split('\n')[0] + '\n')
        self.refuse('licence', 'rt_core/base/good.cpp:1:', 'rt_core/base/good.hpp:1:')
        self.text('rt_core/CMakeLists.txt', 'add_library(core base/good.hpp)\n')
        self.text('some.sh', f'#!/bin/sh\n\n{SPDX}')
        self.text('some.py', '')
        self.refuse('licence', 'rt_core/CMakeLists.txt:1:', 'some.py:1:', 'some.sh:1:')
        self.text('some.sh', f'#!/bin/sh\n{SPDX}')
        self.accept('licence')


class Structure(House):
    def test_a_source_or_folder_that_is_not_listed_is_refused(self):
        for path in ('tests/unit/test_lost.cpp', 'rt_core/base/lost.hpp', 'transport/idl/lost.idl'):
            with self.subTest(path):
                self.source(path, '')
                self.refuse('files_listed', f'{path}:1: no CMakeLists.txt above it lists it')
        self.script('tests/CMakeLists.txt', '# add_executable(t unit/test_good.cpp)')
        self.refuse('files_listed', 'tests/unit/test_good.cpp:1:')
        self.script('tests/lost/CMakeLists.txt')
        self.refuse('files_listed', 'tests/lost:1:')

    def test_a_file_may_be_listed_in_any_folder_above_and_behind_a_variable(self):
        self.source('tests/unit/test_more.cpp', '')
        self.script('tests/unit/CMakeLists.txt', 'add_executable(m "${here}/test_more.cpp")')
        self.script('tests/CMakeLists.txt', 'add_executable(t unit/test_good.cpp)',
                    'add_subdirectory(unit)')
        self.accept('files_listed')

    def test_a_limit_that_only_a_comment_or_a_rig_names_is_refused(self):
        fault = 'rt_core/limits.hpp:4: kMaxGood is named in no tests/*/test_*.cpp'
        self.source('tests/unit/test_good.cpp', 'int kMaxGoods; // kMaxGood')
        self.source('tests/unit/rig.hpp', 'static_assert(kMaxGood == 1);')
        self.source('tests/bench/test_bench.cpp', 'static_assert(kMaxGood == 1);')
        self.refuse('limits_tested', fault)
        self.source('rt_core/limits.hpp', 'constexpr std::array<int, kMaxGood>', '    kOther{};')
        self.refuse('limits_tested', 'rt_core/limits.hpp:4: kOther is named in no')
        self.source('rt_core/limits.hpp', '')
        self.refuse('limits_tested', 'rt_core/limits.hpp:1: has no constant')

    def test_a_source_that_does_not_include_its_own_header_first_is_refused(self):
        fault = 'its own header, rt_core/base/good.hpp, is not the first include'
        own = '#include "rt_core/base/good.hpp"'
        self.source('rt_core/base/good.cpp', '#include <array>', own)
        self.refuse('own_header_first', f'rt_core/base/good.cpp:4: {fault}')
        self.source('rt_core/base/good.cpp', 'int a;')
        self.refuse('own_header_first', f'rt_core/base/good.cpp:1: {fault}')
        self.source('rt_core/base/good.cpp', own, '#include <array>')
        self.source('rt_core/base/main.cpp', '#include <array>')
        self.accept('own_header_first')

    def test_an_installed_header_whose_comments_name_no_thread_is_refused(self):
        self.source('rt_core/base/good.hpp', 'int* thread(); // A needle.')
        self.refuse('threads_told', 'rt_core/base/good.hpp:1: is installed, and no comment says')
        (self.root / 'rt_core/base/good.hpp').unlink()
        self.refuse('threads_told', 'rt_core/base/good.hpp:1: is installed, and no comment says')
        self.script('cmake/components.cmake', '# rt_core/base/good.hpp')
        self.refuse('threads_told', 'cmake/components.cmake:1: installs no header')


class Pages(House):
    def test_a_page_that_is_not_there_is_refused(self):
        page = 'docs/' 'nowhere.md'
        self.source('rt_core/base/good.hpp', f'// See {page}; a thread.')
        self.refuse('links', f"rt_core/base/good.hpp:4: names '{page}', which is not there")
        self.text('page.md', '[a](../nowhere.md)\n')
        self.refuse('links', "page.md:1: a link to '../nowhere.md', which is not there")

    def test_a_heading_that_is_not_there_is_refused(self):
        self.text('page.md', '# One way\n[a](page.md#one-way) [b](page.md#another)\n')
        self.refuse('links', "page.md:2: a link to 'page.md#another', which is not there")
        self.text('page.md', '```\n# In a block\n[a](nowhere.md)\n```\n[a](#in-a-block)\n')
        self.refuse('links', "page.md:5: a link to '#in-a-block', which is not there")
        self.text('page.md', '[a](rt_core) [b](rt_core#base)\n')
        self.refuse('links', "page.md:1: a link to 'rt_core#base', which is not there")

    def test_links_that_lead_somewhere_pass(self):
        self.text('docs/' 'page.md', '## `A`, an-other_way!\n[a](#a-an-other_way) [b](../rt_core)\n'
                  '[c](http://nowhere.org/nowhere.md) [d](page.md#a-an-other_way)\n')
        self.source('rt_core/base/good.hpp', '// See docs/' 'page.md; a thread.')
        self.accept('links')

    def budget(self, *rows):
        self.text(guards.BUDGETS, '# Pages.\n' + '\n'.join(rows) + '\n')

    def test_a_page_of_too_many_words_or_without_a_budget_is_refused(self):
        page = '# A page\n\nTwo [more words](docs/x) and `no words in code`.\n```\nno\n```\n'
        fault = f'README.md:1: 7 words; at most 6 ({guards.BUDGETS}:2'
        for words, faults in ((7, ()), (6, (fault,))):
            self.text('README.md', page)
            self.budget(f'README.md {words} user')
            if faults:
                self.refuse('page_words', *faults)
            else:
                self.accept('page_words')
        self.text('README.md', page)
        self.refuse('page_words', f'README.md:1: has no line in {guards.BUDGETS}')
        self.budget('README.md 1 user', 'docs/*.md 1 contributor')
        self.refuse('page_words', "page_words.txt:2: names 'README.md', which is not there",
                    "page_words.txt:3: names 'docs/*.md', which is not there")
        self.budget('README.md one user')
        self.refuse('page_words', f'{guards.BUDGETS}:2: not PAGE WORDS', code=2)

    def test_a_sentence_of_36_words_is_refused_and_one_of_35_is_not(self):
        self.budget('README.md 999 user')
        for words in (35, 36):
            sentence = ' '.join(['word'] * words)
            for page, *lines in ((f'# {sentence} a b c\n\n{sentence}.\nAnother one.\n', 3),
                                 (f'* Short.\n* {sentence}\n* {sentence}\n', 2, 3),
                                 (f'| a | b |\n| - | - |\n| {sentence} | {sentence} |\n', 3, 3),
                                 (f'    {sentence} a b c\n\nA.\n`{sentence}` {sentence[5:]}\n', 3)):
                with self.subTest(page):
                    self.budget('README.md 999 user')
                    self.text('README.md', page)
                    if words == 35:
                        self.accept('sentences')
                    else:
                        faults = [f'README.md:{line}: 36 words in ' for line in lines]
                        self.refuse('sentences', *faults)
        self.text('README.md', f'{sentence}\n\n$$\n{sentence}\n$$\n')
        self.budget('README.md 999 contributor')
        self.accept('sentences')

    def test_tests_and_sources_on_a_page_for_users_are_refused(self):
        self.script('tests/CMakeLists.txt', 'add_executable(t unit/test_good.cpp)',
                    'add_test(NAME good.whole COMMAND t)')
        text = ('`tactus/rt_core/a.hpp`, `<rt_core/a.hpp>`, `bash cmake/setup.sh`, `page.md`\n'
                '`good.whole`, `test_good` and\n`rt_core/a.hpp`\n```\nrt_core/a.hpp\n```\n')
        self.text('README.md', text)
        self.text('docs/' 'page.md', text)
        self.budget('README.md 99 user', 'docs/*.md 99 contributor')
        self.refuse('inside_of_users_pages', "README.md:2: names '`good.whole`'",
                    "README.md:2: names '`test_good`'", "README.md:3: names 'rt_core/a.hpp'")

    def test_a_table_that_does_not_parse_is_refused(self):
        table = '| a | b |\n| --- | :-: |\n| `a \\| b` | c |\n| d | |\n'
        self.text('page.md', f'{table}\nWords | and |\n\n```\n| no\n```\n')
        self.accept('tables')
        self.text('page.md', f'{table}\n| e | f |\n| g | h |\n')
        self.refuse('tables', 'page.md:7: a row outside of a table')
        self.text('page.md', f'{table}| e |\n| e | f | g |\n')
        self.refuse('tables', 'page.md:5: 1 cells in a table of 2 columns',
                    'page.md:6: 3 cells in a table of 2 columns')
        self.text('page.md', '| a |\n| - | - |\n')
        self.refuse('tables', 'page.md:2: 2 columns below a head of 1')

    def test_an_option_that_no_program_has_is_refused(self):
        self.text('docs/man/p.1', '\\fB\\-\\-far\\-off\\fR\n')
        self.text('README.md', '`p --far-off`, `cmake --preset x`, a --- b\n```\np --near=1\n```\n')
        self.text('docs/' 'internals/decisions/1.md', '`--gone`\n')
        self.refuse('options_named', "README.md:3: no option is called '--near'")

    def test_a_version_that_the_sources_do_not_have_is_refused(self):
        for source, _ in guards.VERSIONS.values():
            self.text(source, (CHECKOUT / source).read_text())
        page = (CHECKOUT / 'docs/versions.md').read_text()
        self.text('docs/' 'versions.md', page)
        self.accept('versions_told')
        self.text('docs/' 'versions.md', re.sub(r'(SPM coder) \| \d+', r'\1 | 99', page))
        (self.root / 'host_tools/c/tactus.h').unlink()
        self.refuse('versions_told', 'docs/versions.md:1: SPM coder is 99; rt_core/spm/header.hpp',
                    'docs/versions.md:1: C API is 3; host_tools/c/tactus.h has none')

    def test_a_word_of_the_glossary_out_of_order_is_refused(self):
        head = '| Word | Meaning |\n| --- | --- |\n'
        self.text('docs/' 'glossary.md', f'{head}| a, B | 1 |\n| *C* | 1 |\n\n{head}| b | 1 |\n')
        self.accept('glossary_sorted')
        self.text('docs/' 'glossary.md', f'{head}| c | 1 |\n| B | 1 |\n| d | 1 |\n')
        self.refuse('glossary_sorted', "docs/glossary.md:4: 'B' belongs above 'c'")

    def test_a_test_that_is_not_there_is_refused(self):
        def build():
            self.script(
                'tests/CMakeLists.txt', 'add_executable(t unit/test_good.cpp)',
                'foreach(name one two)', 'add_test(NAME good.${name} COMMAND t)',
                'add_test(NAME good.part_${name} COMMAND t)', 'endforeach()',
                'add_test(NAME other.whole COMMAND t) # NAME other.comment',
                'tactus_test(test_all SOURCES unit/test_good.cpp)')
            self.source('tests/unit/test_good.cpp', 'TEST_F(GoodSuite, says_so) {}',
                        'TYPED_TEST(TypedSuite, says_so) {}', 'RC_GTEST_PROP(GivenSuite, a, ()) {}',
                        'RC_GTEST_FIXTURE_PROP(DrawnSuite, a, ()) {}')
        named = ('`good.one`, `good.part_two`, `other.whole`, `page.md`, `test_good`\n'
                 '`test_all` GoodSuite, TypedSuite, GivenSuite, DrawnSuite and `test_all`\n')
        build()
        self.text('page.md', named)
        self.accept('named_tests')
        for words, fault in (('`good.three`', "test is called 'good.three'"),
                             ('`other.one`', "test is called 'other.one'"),
                             ('`other.comment`', "test is called 'other.comment'"),
                             ('`good.part_three`', "test is called 'good.part_three'"),
                             ('`test_none`', "test is called 'test_none'"),
                             ('`test_all` GoodSuite, Bad', "suite of tests is called 'Bad'")):
            with self.subTest(words):
                build()
                self.text('page.md', f'{named}{words}\n')
                self.refuse('named_tests', f'page.md:3: no {fault}')


if __name__ == '__main__':
    unittest.main()
