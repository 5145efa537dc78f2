#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The site's sources become the pages that they should, and a faulty one is named with its line."""
import contextlib
import io
import pathlib
import shutil
import sys
import tempfile
import unittest

CHECKOUT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(CHECKOUT / 'docs/site'))
sys.dont_write_bytecode = True
import build  # noqa: E402
import limits  # noqa: E402
import reference  # noqa: E402
import report_keys  # noqa: E402


class Manual(unittest.TestCase):
    def test_options_headings_and_examples_are_kept(self):
        page = reference.manual('p.1', '.TH P 1\n.SH OPTIONS\n.TP\n\\fB\\-\\-far\\-off\\fR '
                                '\\fIFLOAT\\fR (0 to 1)\nHow a_b is. Default: 1.\n.PP\n.B p\nends.\n'
                                '.SH EXAMPLES\n.nf\np \\-\\-far\\-off 1 *\n.fi\n')
        for part in ('.. program:: p', '.. option:: --far-off FLOAT (0 to 1)\n\n   How a\\_b is.',
                     '\n**p**\nends.', 'Examples\n--------', '::\n\n   p --far-off 1 *\n'):
            self.assertIn(part, page)

    def test_a_macro_that_is_not_known_is_named_with_its_line(self):
        with self.assertRaises(reference.Fault) as raised:
            reference.manual('p.1', '.TH P 1\n.SH NAME\n.Ft x\n')
        self.assertEqual(raised.exception.args[:2], ('p.1', 3))


class Headers(unittest.TestCase):
    def test_each_public_header_has_a_group_and_keeps_its_lines(self):
        headers = reference.public_headers(CHECKOUT)
        self.assertGreater(len(headers), 90)
        names = {name for name, _, _ in reference.GROUPS}
        for header in headers:
            text = (CHECKOUT / header).read_text(encoding='utf-8')
            self.assertIn(reference.group_of(header), names)
            self.assertEqual(text.count('\n'), reference.grouped(header, text).count('\n'), header)
        self.assertLessEqual(set(reference.EXCEPTIONS), set(headers))

    def test_comments_of_the_c_header_become_those_of_doxygen(self):
        text = reference.c_header('// 1\n#pragma once\n/* A kind. */\ntypedef enum kind\n{\n'
                                  '    ONE = 1 /* First. */\n} kind;\n')
        self.assertIn('/** A kind. */\nenum kind\n{\n    ONE = 1 /**< First. */\n};', text)


class Python(unittest.TestCase):
    def test_signatures_are_of_the_stub_and_words_of_the_module(self):
        page = reference.python_page(
            'N: int\nclass A:\n    def __init__(self, p: str = "x") -> None: ...\n'
            '    def run(self, n: int = 0) -> float: ...\n    @property\n    def b(self) -> int: ...\n',
            'module.doc() =\n R"(All of it.)";\n py::class_<A>(module, "A", "One A.")\n'
            '.def(py::init<int>(), "p"_a = "x", "Makes it.")\n'
            '.def("run", &A::run, "n"_a = 0,\n "Runs " "once.")\n.def_readonly("b", &A::b);\n')
        for part in ('All of it.', '.. py:data:: N', ".. py:class:: A(p: str='x')\n\n   One A.",
                     '   Makes it.', '.. py:method:: run(n: int=0) -> float\n\n      Runs once.',
                     '.. py:property:: b\n      :type: int'):
            self.assertIn(part, page)

    def test_each_public_name_of_the_module_is_on_the_page(self):
        folder = CHECKOUT / 'host_tools/python'
        stub, *sources = ((folder / name).read_text(encoding='utf-8')
                          for name in ('tactus.pyi', 'module.cpp', 'world.cpp'))
        page = reference.python_page(stub, *sources)
        for name in ('Moves the tools through N poses', 'Sets the pose of an object', 'Frame(models',
                     'Answers of a path of N poses', 'function:: touch(model', 'on its path over a'):
            self.assertIn(name, page)


class Limits(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name)
        for path in (limits.SOURCE, limits.PAGE):
            (self.root / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(CHECKOUT / path, self.root / path)

    def run_limits(self, *options):
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            return limits.main([str(self.root), *options]), said.getvalue()

    def edit(self, path, old, new):
        text = (self.root / path).read_text(encoding='utf-8')
        self.assertIn(old, text)
        (self.root / path).write_text(text.replace(old, new), encoding='utf-8')

    def test_another_limit_is_named_with_its_line_until_it_is_written(self):
        self.assertEqual(self.run_limits(), (0, ''))
        self.edit(limits.SOURCE, 'kMaxTools = 16;', 'kMaxTools = 2 * 8 + 1;')
        code, said = self.run_limits()
        self.assertEqual(code, 1)
        self.assertRegex(said, r'^docs/conventions.md:\d+: not the limits of rt_core/limits.hpp')
        self.assertEqual(self.run_limits('--write'), (0, ''))
        self.assertIn('| 17 | Refused |', (self.root / limits.PAGE).read_text(encoding='utf-8'))
        self.assertEqual(self.run_limits(), (0, ''))

    def test_a_limit_that_is_not_there_or_not_understood_ends_with_2(self):
        self.edit(limits.SOURCE, 'kMaxTools = 16;', 'kMaxTools = sizeof(int);')
        self.assertEqual(self.run_limits()[0], 2)
        self.edit(limits.SOURCE, 'std::uint32_t kMaxTools = sizeof(int);', 'int kOther = 1;')
        code, said = self.run_limits()
        self.assertEqual((code, said), (2, 'limits.py: rt_core/limits.hpp: there is no kMaxTools\n'))


class ReportKeys(unittest.TestCase):
    PAGE = ('# Report format\n\n| key |\n| --- |\n| `schema` |\n\n## work\n\n`a` and `b` each hold:\n\n'
            '| key | unit |\n| --- | --- |\n| `n` | of `x`, `y` |\n\n## tools\n\n'
            '| key |\n| --- |\n| `events[].name` |\n| `work` as in [work](#work) |\n')
    REPORT = {'schema': 1, 'work': {'a': {'n': {'x': 1}}, 'b': {'n': {'y': 2}}},
              'tools': [{'events': [{'name': 'e'}], 'work': {'a': 1}}, {'events': []}]}

    def faults(self, page=PAGE, **changes):
        return list(report_keys.faults(page, {**self.REPORT, **changes}))

    def test_a_key_is_in_a_table_or_the_text_of_its_section(self):
        self.assertEqual(self.faults(), [])
        self.assertEqual(self.faults(tools=[]), [])

    def test_a_key_that_the_page_lacks_is_named(self):
        self.assertEqual(self.faults(more={}),
                         [(1, "has no section and no row for the key 'more'")])
        self.assertEqual(self.faults(tools=[{'events': [{'name': 1, 'when': 2}], 'work': 1}]),
                         [(1, "names no key 'tools.events.when'")])

    def test_a_row_without_a_key_is_named_with_its_line(self):
        page = self.PAGE.replace('| `schema` |', '| `schema` |\n| `old` |')
        self.assertEqual(self.faults(page), [(6, "no report has the key 'old'")])
        page = self.PAGE.replace('events[].name', 'events[].title')
        self.assertIn((19, "no report has the key 'tools.events[].title'"), self.faults(page))

    def test_a_key_of_the_sources_that_the_page_lacks_is_named(self):
        with tempfile.TemporaryDirectory() as scratch:
            root = pathlib.Path(scratch)
            for path, text in ((report_keys.PAGE, self.PAGE),
                               *((source, '\n{"work", {{"n", 1}}}') for source in
                                 report_keys.SOURCES)):
                (root / path).parent.mkdir(parents=True, exist_ok=True)
                (root / path).write_text(text)
            said = io.StringIO()
            with contextlib.redirect_stdout(said):
                self.assertEqual(report_keys.main([scratch]), 0)
                (root / report_keys.SOURCES[1]).write_text('\n\n{"odd", 1}')
                self.assertEqual(report_keys.main([scratch]), 1)
            self.assertIn(f"{report_keys.SOURCES[1]}:3: {report_keys.PAGE} has no key 'odd'",
                          said.getvalue())


class Pages(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.docs = pathlib.Path(scratch.name).resolve() / 'docs'

    def test_links_lead_to_pages_of_the_site(self):
        (self.docs / 'examples').mkdir(parents=True)
        page = self.docs / 'page.md'
        page.write_text('[a](../README.md) [b](man/hrtc.1) [c](../rt_core/x.hpp) [d](#e) [f](o.md#g)\n'
                        '[h](http://x.org/) ![i](j.png) [k](examples) [l](internals/decisions)\n')
        (self.docs / build.DECISIONS).mkdir(parents=True)
        self.assertEqual(build.page_on_site(self.docs, page),
                         '[a](index.md) [b](man/hrtc.rst) c [d](#e) [f](o.md#g)\n'
                         '[h](http://x.org/) ![i](j.png) k [l](internals/decisions/README.md)\n')

    def test_lists_become_the_navigation(self):
        self.docs.mkdir()
        (self.docs / 'README.md').write_text('# T\n\n## Start\n\nWords.\n\n* [First page](first.md)\n'
                                             '* [hrtc](man/hrtc.1): words\n')
        self.assertIn(':caption: Start\n\nFirst page <first>\nhrtc <man/hrtc>\n```',
                      build.index_page(self.docs))

    @unittest.skipIf(build.missing_tools(), 'needs the packages of cmake/packages-docs.txt')
    def test_a_dead_link_fails_the_build_and_is_named_with_its_line(self):
        root = self.docs.parent
        for path in ('cmake/components.cmake', 'host_tools/python/tactus.pyi', 'CMakeLists.txt',
                     'host_tools/python/module.cpp', 'host_tools/python/world.cpp',
                     'host_tools/c/tactus.h'):
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(CHECKOUT / path, root / path)
        (root / 'cmake/components.cmake').write_text('rt_core/base/result.hpp\n')
        (root / 'rt_core/base').mkdir(parents=True)
        shutil.copy(CHECKOUT / 'rt_core/base/result.hpp', root / 'rt_core/base')
        shutil.copytree(CHECKOUT / 'docs/man', self.docs / 'man')
        (self.docs / 'library.md').write_text('# Library\n\nA [dead link](library.md#nowhere).\n')
        pages = ''.join(f'* [{page.stem}](man/{page.name})\n'
                        for page in (self.docs / 'man').glob('*.1'))
        (self.docs / 'README.md').write_text(
            f'# T\n\n## Guides\n\n* [Library](library.md)\n{pages}\n## Reference\n\n'
            '* [hrtc](man/hrtc.1)\n')
        ended = build.subprocess.run(
            (sys.executable, '-B', CHECKOUT / 'docs/site/build.py', root, root / 'out'),
            capture_output=True, text=True, check=False)
        self.assertEqual(ended.returncode, 1, ended.stdout + ended.stderr)
        self.assertRegex(ended.stderr, r'library\.md:3: WARNING: .*library\.md#nowhere')


if __name__ == '__main__':
    unittest.main()
