# SPDX-License-Identifier: Apache-2.0
"""Reference pages in reStructuredText, each from the source that programs and compilers read."""
import ast
import re

# Group of the C++ reference: (its name, its title, beginnings of the paths of its headers). A
# header belongs to the first group that names it.
GROUPS = (
    ('world', 'World', ('platform/world/', 'platform/loop/hand_state')),
    ('frame', 'Frame', ('rt_core/frame/', 'rt_core/records/frame_', 'rt_core/records/local_',
                        'rt_core/records/mesh_', 'rt_core/records/predict',
                        'rt_core/records/work_', 'rt_core/base/arena', 'rt_core/kernels/')),
    ('tools', 'Tools', ('rt_core/geometry/convex', 'rt_core/geometry/shapes',
                        'rt_core/geometry/tool', 'rt_core/records/contact',
                        'rt_core/records/tool_')),
    ('scene', 'Scene', ('rt_core/records/', 'rt_core/geometry/', 'transport/pose',
                        'transport/shown_')),
    ('device', 'Device', ('platform/devices/',)),
    ('force', 'Force', ('rt_core/force/',)),
    ('streaming', 'Streaming', ('transport/base/', 'transport/')),
    ('recording', 'Recording', ('platform/recording/',)),
    ('machine', 'Real-time loop', ('platform/machine/',)),
    ('host', 'Meshes and models', ('host_tools/', 'rt_core/spm/')),
    ('basics', 'Basics and limits', ('rt_core/',)),
)
# Headers whose folder belongs elsewhere.
EXCEPTIONS = {
    'rt_core/records/device_limits.hpp': 'device', 'rt_core/records/device_record.hpp': 'device',
    'rt_core/records/safety.hpp': 'force', 'transport/store/static_model.hpp': 'host',
    'transport/base/refusal.hpp': 'basics', 'transport/base/print_assertions.hpp': 'basics',
    'rt_core/base/realtime.hpp': 'machine',
}
C_HEADER = 'host_tools/c/tactus.h'
# Header that programs include instead of one of these.
SHORT_NAMES = {'platform/world/world.hpp': 'world.hpp'}


class Fault(Exception):
    """The source of a reference page is not as expected: (path, line, text)."""


def heading(text, line='='):
    return [text, line * len(text), '']


# --- Command line --------------------------------------------------------------------------------

FONTS = {'B': '**', 'I': '*', 'R': ''}


def plain(text):
    """Roff text without its escapes, as reStructuredText."""
    text = re.sub(r'\\\*|\\&', '', text).replace('\\\\', '\0').replace('\\-', '-')
    parts = re.split(r'\\f([BIR])', text)
    spans = [(parts[at - 1] if at else 'R', parts[at]) for at in range(0, len(parts), 2)]
    return ''.join(marked(FONTS[font], span) for font, span in spans).replace('\0', '\\\\')


def marked(mark, text):
    """The text between marks; white space at its ends is left outside of them."""
    inner = text.strip()
    if not inner:
        return text
    lead, tail = text[:len(text) - len(text.lstrip())], text[len(text.rstrip()):]
    escaped = re.sub(r'([*`|_@])', r'\\\1', inner)
    if not mark:
        escaped = re.sub(r'(?<![\w-])--[a-z][a-z0-9-]*', r'``\g<0>``', escaped)
    # An escaped space ends a mark in the middle of a word.
    return f'{lead}{mark}{escaped}{mark}' + ('\\ ' if mark and not tail else '') + tail


def words_of(line):
    return [word.strip('"') for word in re.findall(r'"[^"]*"|\S+', line)]


def macro(name, rest):
    """Text of a line with one of the macros for fonts: .B, .I, .BR, .RI, ..."""
    if len(name) == 1:
        return plain(f'\\f{name}' + ' '.join(words_of(rest)))
    return ''.join(plain(f'\\f{name[at % 2]}{word}') for at, word in enumerate(words_of(rest)))


BREAK = '.br'


def with_breaks(paragraph):
    """The paragraph; as a block of lines if it has breaks."""
    if BREAK not in paragraph.split('\n'):
        return paragraph
    lines = paragraph.split(f'\n{BREAK}\n')
    return '\n'.join('| ' + line.replace('\n', ' ').strip() for line in lines)


def manual(path, text):
    """reStructuredText of a manual page in the few macros that ours use."""
    out, indent, is_verbatim, wants_name, program = [], '', False, False, ''
    for number, line in enumerate(text.splitlines(), 1):
        found = re.match(r'\.([A-Za-z]+) ?(.*)$', line)
        if line.startswith('.\\"') or (found and found[1] == 'TH'):
            program = words_of(found[2])[0].lower() if found else program
            out += [f'.. program:: {program}', ''] if found else []
        elif found and found[1] in ('SH', 'SS'):
            indent = ''
            title = plain(found[2])
            title = title.capitalize() if found[1] == 'SH' else title
            if title.lower().startswith(f'{program} '):
                title = title.lower()
                out += ['', f'.. program:: {title}', '']
            out += ['', *heading(title, '-' if found[1] == 'SH' else '~')]
        elif found and found[1] in ('TP', 'PP'):
            indent, wants_name = '', found[1] == 'TP'
            out.append('')
        elif found and found[1] in ('nf', 'fi'):
            is_verbatim = found[1] == 'nf'
            out += ['', '::', ''] if is_verbatim else ['']
        elif found and found[1] == 'br':
            out.append(BREAK)
        elif found and not re.fullmatch('[BIR]{1,2}', found[1]):
            raise Fault(path, number, f'macro .{found[1]} is not understood')
        else:
            body = macro(found[1], found[2]) if found else plain(line)
            if is_verbatim:
                text = ' '.join(words_of(found[2])) if found else line
                out.append('   ' + re.sub(r'\\f[BIR]|\\&', '', text).replace('\\-', '-'))
            elif wants_name and re.match(r'\\f[BI](\\-|[A-Z])', line):
                option = re.sub(r'\\f[BIR]|\*\*', '', line).replace('\\-', '-')
                out += [f'.. option:: {option}', '']
                indent, wants_name = '   ', False
            elif wants_name:
                out.append(body)
                indent, wants_name = '   ', False
            else:
                out.append(indent + body)
    paragraphs = map(with_breaks, '\n'.join(out).split('\n\n'))
    return re.sub(r'\\ $', '', '\n\n'.join(paragraphs), flags=re.M) + '\n'


# --- C and C++ -----------------------------------------------------------------------------------

def public_headers(root):
    """The headers that are installed, in the order of cmake/components.cmake."""
    text = re.sub('#.*', '', (root / 'cmake/components.cmake').read_text(encoding='utf-8'))
    found = re.findall(r'\b(?:rt_core|transport|platform|host_tools)/[a-z0-9_/]+\.hpp\b', text)
    return list(dict.fromkeys(found))


def group_of(header):
    if header in EXCEPTIONS:
        return EXCEPTIONS[header]
    return next(name for name, _, beginnings in GROUPS if header.startswith(beginnings))


def grouped(header, text):
    """The header with its namespaces in its group, line by line as before."""
    text = re.sub(r'^(namespace tactus[^\n{]*)\n\{',
                  rf'\1 {{ /** @addtogroup {group_of(header)}\n@{{ */', text, flags=re.M)
    text = re.sub(r'^\} // namespace tactus', '/** @} */ }', text, flags=re.M)
    # Breathe can't read defaults with named members; NAME@HASH is no command of Doxygen.
    text = re.sub(r' ?=? ?\{\s*\.[^{}]*\}', lambda default: '\n' * default[0].count('\n'), text)
    return re.sub(r'@(?=[A-Z])', r'\\@', text)


def c_header(text):
    """The C header with comments that Doxygen reads, and each type declared once."""
    text = re.sub(r'^(\s*)/\* (?!----)', r'\1/** ', text, flags=re.M)
    text = re.sub(r'(\S[ ]+)/\* ', r'\1/**< ', text)
    text = re.sub(r'typedef ((?:enum|struct) \w+)(?=\n)', r'\1', text)
    text = re.sub(r'^\} \w+;', '};', text, flags=re.M)
    text = re.sub(r'typedef (struct (\w+)) \2;', r'\1;', text)
    text = re.sub(r'(?<=[A-Z])@(?=[A-Z])', r'\\@', text).replace('#pragma once', '')
    return '/** @addtogroup c\n@{ */' + text.split('\n', 1)[1] + '/** @} */\n'


def with_pages(text):
    """Text of a comment with the pages that it names as links."""
    return re.sub(r'docs/([\w/-]+)\.md', r':doc:`/\1`', re.sub('`([^`]+)`', r'``\1``', text))


def group_page(name, title, note):
    return '\n'.join([*heading(title), note, '', f'.. doxygengroup:: {name}', '   :content-only:',
                      '   :members:', ''])


def api_pages(root):
    """(name, text) of each page of the C++ and the C reference, an index first."""
    headers = public_headers(root)
    names = [f'cpp_{name}' for name, _, _ in GROUPS]
    yield 'cpp', '\n'.join([
        *heading('C++ API'), 'Public headers by subject. Headers below ``<tactus/detail/>`` are not',
        'for programs.', '',
        '.. toctree::', '   :maxdepth: 1', '', *(f'   {name}' for name in names), ''])
    for name, title, _ in GROUPS:
        own = [header for header in headers if group_of(header) == name]
        note = '\n'.join(['.. code-block:: cpp', '',
                          *(f'   #include <tactus/{SHORT_NAMES.get(header, header)}>'
                            for header in own)])
        yield f'cpp_{name}', group_page(name, title, note)
    text = (root / C_HEADER).read_text(encoding='utf-8')
    about = re.sub(r'^ ?\*', '', re.search(r'/\*(.*?)\*/', text, re.S)[1], flags=re.M)
    yield 'c', group_page('c', 'C API', '.. code-block:: c\n\n   #include <tactus/tactus.h>\n\n'
                          + '\n'.join(line.strip() for line in with_pages(about).split('\n')))


# --- Python --------------------------------------------------------------------------------------

def docstrings(text):
    """(class, or '' for the module; member) -> docstring, from a source of the module."""
    whole = re.search(r'module\.doc\(\) =\s*R"\((.*?)\)"', text, re.S)
    found = {('', ''): whole[1]} if whole else {}
    for name, rest in re.findall(r'module\.def\("(\w+)",(.*?)\);\n', text, re.S):
        found['', name] = string_of(rest)
    for block in re.split(r'py::class_<', text)[1:]:
        name = re.search(r'\(\s*module,\s*"(\w+)"', block)[1]
        head, *members = re.split(r'\.def(?:_static|_readonly|_property_readonly)?\(', block)
        found[name, ''] = string_of(head.split(f'"{name}"', 1)[1])
        for member in members:
            called = re.match(r'\s*(?:"(\w+)"|py::init)', member)
            rest = member[called.end():] if called else ''
            found[name, (called[1] or '__init__') if called else ''] = string_of(rest)
    return found


def string_of(code):
    """The docstring among a call's arguments; empty without one."""
    code = re.split(r'module\.(?:attr|def)\b', code)[0]
    code = re.sub(r'(?:"\w+"_a(?: = (?:"[^"]*"|[^,")]+))?)', '', code)
    raw = re.search(r'R"\((.*?)\)"', code, re.S)
    if raw:
        return raw[1].strip()
    return ''.join(re.findall(r'"([^"]*)"', code))


def signature(function, is_method):
    arguments = ast.unparse(function.args)
    if is_method:
        arguments = re.sub(r'^self(, )?', '', arguments)
    returned = ast.unparse(function.returns) if function.returns else 'None'
    return f'({arguments})' + ('' if function.name == '__init__' else f' -> {returned}')


def text_of(doc, indent):
    """A docstring at an indentation, its examples apart from its text."""
    doc = re.sub(r'(?<=\n)(?=>>>)|(?<!\n)\n(?=>>>)', '\n', doc, count=1)
    doc = with_pages(re.sub(r'(?<=[A-Z])@(?=[A-Z])', r'\\@', doc))
    return [indent + line if line else '' for line in doc.split('\n')] + [''] if doc else []


def python_page(stub, *sources):
    """The module's names, from its stub and the docstrings of its sources."""
    docs = {place: doc for source in sources for place, doc in docstrings(source).items()}
    tree = ast.parse(stub)
    page = [*heading('Python API'), '.. py:module:: tactus', '', *text_of(docs['', ''], '')]
    constants = [node.target.id for node in tree.body if isinstance(node, ast.AnnAssign)]
    page += ['.. py:data:: ' + '\n             '.join(constants), '']
    for node in (node for node in tree.body if isinstance(node, ast.ClassDef)):
        init = next((f for f in node.body if getattr(f, 'name', '') == '__init__'), None)
        page += [f'.. py:class:: {node.name}' + (signature(init, True) if init else ''), '',
                 *text_of(docs.get((node.name, ''), ''), '   '),
                 *text_of(docs.get((node.name, '__init__'), ''), '   ')]
        for member in node.body:
            if isinstance(member, ast.AnnAssign):
                page += [f'   .. py:attribute:: {member.target.id}',
                         f'      :type: {ast.unparse(member.annotation)}', '']
            elif isinstance(member, ast.FunctionDef) and member.name != '__init__':
                marks = [ast.unparse(mark) for mark in member.decorator_list]
                doc = text_of(docs.get((node.name, member.name), ''), '      ')
                if 'property' in marks:
                    page += [f'   .. py:property:: {member.name}',
                             f'      :type: {ast.unparse(member.returns)}', '', *doc]
                else:
                    static = 'staticmethod' in marks
                    page += [f'   .. py:method:: {member.name}{signature(member, not static)}',
                             *(['      :staticmethod:'] if static else []), '', *doc]
    for node in (node for node in tree.body if isinstance(node, ast.FunctionDef)):
        page += [f'.. py:function:: {node.name}{signature(node, False)}', '',
                 *text_of(docs.get(('', node.name), ''), '   ')]
    return '\n'.join(page) + '\n'
