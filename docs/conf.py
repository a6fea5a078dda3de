"""Settings of the documentation: MyST pages, notebooks kept as Python files, docstrings."""

import fdspec

project = "fdspec"
author = "fdspec contributors"
copyright = "2026, fdspec contributors"
version = release = fdspec.__version__

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.viewcode"]
exclude_patterns = ["_build", "conf.py", "jupyter_execute", "notebooks/README.md"]

html_theme = "furo"
html_title = f"fdspec {release}"

myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
# A changelog repeats its headings.
suppress_warnings = ["myst.xref_ambiguous"]

# docs/notebooks is a link to notebooks/, whose files are Python in the percent format; each runs in a kernel
# of its own, and a cell that fails, or a notebook that takes longer than this, fails the build.
nb_custom_formats = {".py": ["jupytext.reads", {"fmt": "py:percent"}]}
nb_execution_mode = "force"
nb_execution_timeout = 300
nb_execution_raise_on_error = True
nb_merge_streams = True

autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
python_use_unqualified_type_names = True
napoleon_google_docstring = False
napoleon_use_rtype = False
