# SPDX-License-Identifier: Apache-2.0
"""Sphinx's settings for the site that build.py makes of the pages, without any network."""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]

project = 'Tactus'
copyright = 'the Tactus authors'
release = re.search(r'VERSION (\d+\.\d+\.\d+)', (ROOT / 'CMakeLists.txt').read_text())[1]
version = release
extensions = ['myst_parser', 'breathe', 'sphinx.ext.mathjax']
nitpicky = False  # Types of detail/ have no page.

smartquotes = False  # --place stays as it is.
myst_heading_anchors = 4
myst_enable_extensions = ['dollarmath', 'deflist']

breathe_default_project = 'tactus'
breathe_domain_by_extension = {'h': 'c', 'hpp': 'cpp'}
cpp_index_common_prefix = ['tactus::']

html_theme = 'furo'
html_title = f'Tactus {release}'
html_static_path = [str(pathlib.Path(__file__).parent / 'static')]
html_css_files = ['site.css']
html_copy_source = False
html_last_updated_fmt = None
mathjax_path = 'mathjax/MathJax.js?config=TeX-AMS_CHTML'  # build.py puts Debian's there.
mathjax2_config = {
    'showMathMenu': False, 'messageStyle': 'none',
    'tex2jax': {'inlineMath': [['\\(', '\\)']], 'displayMath': [['\\[', '\\]']],
                'processClass': 'math'},
}
myst_update_mathjax = False  # It would configure version 3.
