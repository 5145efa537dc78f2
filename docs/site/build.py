#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""build.py ROOT OUTPUT: the documentation of the checkout ROOT as a site, in OUTPUT/html.

Copies the pages of docs/, whose lines stay as they are, adds the generated reference and runs
Doxygen and Sphinx over them, without a network. Lists and links of docs/README.md make the
navigation. A warning is a fault: OUTPUT/source has the page and the line that it names.
Exit codes: 0 done, 1 a page is faulty, 2 a tool is missing or failed, 3 wrong usage.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

import reference

SITE = pathlib.Path(__file__).resolve().parent
MATHJAX = pathlib.Path('/usr/share/javascript/mathjax')
MATHJAX_PARTS = ('MathJax.js', 'config/TeX-AMS_CHTML.js', 'extensions', 'jax/element',
                 'jax/input/TeX', 'jax/output/CommonHTML', 'fonts/HTML-CSS/TeX/woff')
LINK = re.compile(r'(!?\[[^\]]*)\]\(([^() :]+)\)')
DECISIONS = 'internals/decisions'
DECISIONS_PAGE = '# Decisions\n\n```{toctree}\n:glob:\n:maxdepth: 1\n\n*\n```\n'
# Pages that only the site has; docs/README.md can't link to them.
GENERATED = {'Reference': ('reference/cpp', 'reference/c', 'reference/python')}


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding='utf-8')


def read(path):
    return path.read_text(encoding='utf-8')


# --- Pages ---------------------------------------------------------------------------------------

def link_on_site(docs, page, target):
    """Where a link of the page leads on the site; None if its target is not part of the site."""
    path, hash_mark, anchor = target.partition('#')
    if not path:
        return target
    full = pathlib.Path(os.path.normpath(page.parent / path))
    if full == docs.parent / 'README.md':
        full = docs / 'README.md'
    if docs not in full.parents:
        return None
    if full.is_dir():
        if full != docs / DECISIONS and not (full / 'README.md').exists():
            return None
        full = full / 'README.md'
    if full.parent == docs / 'man':
        full = full.with_suffix('.rst')
    if full == docs / 'README.md':
        full = docs / 'index.md'
    return os.path.relpath(full, page.parent) + hash_mark + anchor


def page_on_site(docs, page):
    """The page's text with the site's links; one that leaves the site is its words alone."""
    def rewritten(match):
        target = link_on_site(docs, page, match[2])
        return f'{match[1]}]({target})' if target else match[1].lstrip('[')

    return LINK.sub(rewritten, read(page))


def sections(text):
    """(heading, (words, target) of the links of its list) of docs/README.md."""
    for part in re.split(r'^## ', text, flags=re.M)[1:]:
        title, _, body = part.partition('\n')
        if found := re.findall(r'^\* \[([^\]]+)\]\(([^() :]+)\)', body, re.M):
            yield title, found


def index_page(docs):
    """docs/README.md with its lists as navigation."""
    text = page_on_site(docs, docs / 'README.md')
    for title, found in sections(text):
        names = [f'{words} <{re.sub(r"[.](md|rst)$", "", target)}>' for words, target in found]
        text += '\n'.join(['', '```{toctree}', ':hidden:', f':caption: {title}', '', *names,
                           *GENERATED.get(title, ()), '```', ''])
    return text


def stage_pages(root, source):
    docs = root / 'docs'
    for path in sorted(docs.rglob('*')):
        relative = path.relative_to(docs)
        if path.is_dir() or relative.parts[0] in ('site', 'man'):
            continue
        if path == docs / 'README.md':
            write(source / 'index.md', index_page(docs))
        elif path.suffix == '.md':
            write(source / relative, page_on_site(docs, path))
        else:
            (source / relative).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(path, source / relative)
    if not (docs / DECISIONS / 'README.md').exists():
        write(source / DECISIONS / 'README.md', DECISIONS_PAGE)


def stage_reference(root, output):
    source = output / 'source'
    for page in sorted((root / 'docs/man').glob('*.1')):
        body = reference.manual(f'docs/man/{page.name}', read(page))
        title = '\n'.join(reference.heading(page.stem))
        write(source / f'man/{page.stem}.rst', title + body)
    for name, text in reference.api_pages(root):
        write(source / f'reference/{name}.rst', text)
    write(source / 'reference/python.rst',
          reference.python_page(read(root / 'host_tools/python/tactus.pyi'),
                                *(read(root / f'host_tools/python/{name}.cpp')
                                  for name in ('module', 'world'))))
    for header in reference.public_headers(root):
        write(output / 'include/tactus' / header,
              reference.grouped(header, read(root / header)))
    write(output / 'include/tactus/tactus.h', reference.c_header(read(root / reference.C_HEADER)))


# --- Tools ---------------------------------------------------------------------------------------

DOXYFILE = """
PROJECT_NAME = Tactus
INPUT = {output}/include
RECURSIVE = YES
FILE_PATTERNS = *.h *.hpp
STRIP_FROM_PATH = {output}/include/tactus
OUTPUT_DIRECTORY = {output}
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
XML_PROGRAMLISTING = NO
AUTOLINK_SUPPORT = NO
SEARCH_INCLUDES = NO
MACRO_EXPANSION = YES
EXPAND_ONLY_PREDEF = YES
PREDEFINED = TACTUS_NONBLOCKING= TACTUS_CALL= __attribute__(x)=
QUIET = YES
WARN_IF_UNDOCUMENTED = NO
WARN_AS_ERROR = FAIL_ON_WARNINGS
"""


def missing_tools():
    tools = [tool for tool in ('doxygen', 'sphinx-build') if not shutil.which(tool)]
    return tools + ([] if MATHJAX.is_dir() else [str(MATHJAX)])


def run(*command):
    return subprocess.run(command, check=False).returncode


def bundle_furo(static):
    """Debian's furo.js imports another file, which browsers refuse in a script that is no module."""
    scripts = static / 'scripts'
    furo = re.sub(r'^import Gumshoe .*\n', '', read(scripts / 'furo.js'))
    write(scripts / 'furo.js', read(scripts / 'gumshoe-patched.js') + furo)


def add_mathjax(static):
    for part in MATHJAX_PARTS:
        target = static / 'mathjax' / part
        target.parent.mkdir(parents=True, exist_ok=True)
        if (MATHJAX / part).is_dir():
            shutil.copytree(MATHJAX / part, target, dirs_exist_ok=True)
        else:
            shutil.copy2(MATHJAX / part, target)


def main(arguments):
    if len(arguments) != 2 or not (pathlib.Path(arguments[0]) / 'docs/README.md').is_file():
        print('build.py: give ROOT, a checkout, and OUTPUT, a folder', file=sys.stderr)
        return 3
    root, output = (pathlib.Path(argument).resolve() for argument in arguments)
    if missing := missing_tools():
        print(f'build.py: missing: {" ".join(missing)} (cmake/packages-docs.txt)', file=sys.stderr)
        return 2
    for folder in ('source', 'include', 'xml', 'html'):
        shutil.rmtree(output / folder, ignore_errors=True)
    try:
        stage_pages(root, output / 'source')
        stage_reference(root, output)
    except reference.Fault as fault:
        print('{}:{}: {}'.format(*fault.args), file=sys.stderr)
        return 1
    write(output / 'Doxyfile', DOXYFILE.format(output=output))
    if run('doxygen', str(output / 'Doxyfile')):
        return 1
    code = run('sphinx-build', '-q', '-W', '--keep-going', '-j', 'auto', '-c', str(SITE), '-D',
           f'breathe_projects.tactus={output}/xml', '-d', str(output / 'doctrees'),
           str(output / 'source'), str(output / 'html'))
    if (static := output / 'html/_static').is_dir():
        bundle_furo(static)
        add_mathjax(static)
    if code:
        return 1
    print(f'Site: {output}/html/index.html')
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
