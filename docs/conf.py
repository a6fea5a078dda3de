"""Settings of the documentation: pages, notebooks kept as Python files, docstrings, and what is generated."""

import os
import re
import sys
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.util import logging

import fdspec
from fdspec import variables

sys.path.insert(0, str(Path(__file__).parent))

from generated import commands  # beside this file

# Kernels inherit it, and would then keep the figures of pyplot to themselves.
os.environ.pop("MPLBACKEND", None)
# A page shows no warning, so that none may be given: the notebook fails.
os.environ["PYTHONWARNINGS"] = "error::UserWarning"

project = "fdspec"
author = "fdspec contributors"
copyright = "2026, fdspec contributors"
version = release = fdspec.__version__

# Formulas are read without a net too: the last one brings MathJax along.
extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
    "sphinx-mathjax-offline",
]
exclude_patterns = ["_build", "conf.py", "generated.py", "jupyter_execute", "notebooks/README.md"]

# What docstrings set apart are formulas; code has its prompt.
highlight_language = "none"
# Quotes are made round; -- before an option is not a dash.
smartquotes_action = "qe"

html_theme = "furo"
html_title = f"fdspec {release}"
html_static_path = ["_static"]
html_css_files = ["fdspec.css"]

myst_enable_extensions = ["amsmath", "attrs_inline", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
# A changelog repeats its headings.
suppress_warnings = ["myst.xref_ambiguous"]

# docs/notebooks is a link to notebooks/, whose files are Python in the percent format; each runs in a kernel
# of its own, and a cell that fails fails the build. How long they take is told at the end and fails nothing:
# a clock says more of the machine than of the page. The limit is for what hangs.
nb_custom_formats = {".py": ["jupytext.reads", {"fmt": "py:percent"}]}
nb_execution_mode = "force"
nb_execution_timeout = 3600
nb_execution_raise_on_error = True
nb_merge_streams = True
# Where no kernel is compiled yet, stderr says so; which notebook is the first is chance.
nb_output_stderr = "remove"

autodoc_member_order = "bysource"
# Docstrings say what each argument is, with shape and unit; types would spread a signature over a page.
autodoc_typehints = "none"
autodoc_preserve_defaults = True
maximum_signature_line_length = 88
python_use_unqualified_type_names = True
napoleon_google_docstring = False
napoleon_use_rtype = False


def setup(app: Sphinx) -> None:
    """Hook in what is generated, and tell how long the notebooks took."""
    app.connect("source-read", fill)
    app.connect("env-updated", tell_times)


def fill(_: Sphinx, docname: str, source: list[str]) -> None:
    """Put the registry's tables into the page on files, and every command's help into its reference."""
    if not docname.startswith("notebooks/"):
        source[0] = kept_together(source[0])
    if docname == "schema":
        for name in ("CUBE", "BUILDING_CUBE", "HISTORY"):
            source[0] = source[0].replace(f"@@{name}@@", table_of(getattr(variables, name)))
    if docname == "cite":
        source[0] = source[0].replace("@@VERSION@@", release)
    if docname == "cli":
        source[0] = source[0].replace("@@COMMANDS@@", commands())


def kept_together(text: str) -> str:
    """Part no number from its unit or its thousands at the end of a line; code stays as it is written."""
    parts = re.split(r"(^```.*?^```$|`[^`\n]*`)", text, flags=re.MULTILINE | re.DOTALL)
    within = r"(?<=\d) (?=(?:\d{3}|%|kN|MN|mm|ms|kg|s|g)(?!\w))"
    parts[::2] = [re.sub(within, "\u00a0", part) for part in parts[::2]]
    return "".join(parts)


def table_of(registry: variables.Registry) -> str:
    """Return a registry as a table of Markdown."""
    rows = [
        f"| `{one.name}` | {over(one)} | {one.units or '-'} | {one.dtype} | {meaning(one)} |"
        for one in registry.values()
    ]
    return "\n".join(["| name | over | units | type | meaning |", "|---|---|---|---|---|", *rows])


def over(variable: variables.Variable) -> str:
    """Return the dims; most variables have all that there are, which the page says before the table."""
    return "all dims" if len(variable.dims) >= 4 else ", ".join(variable.dims) or "-"


def meaning(variable: variables.Variable) -> str:
    """Return the long name and what flags mean."""
    codes = variable.attributes.get("flag_values")
    if codes is None:
        return variable.long_name
    named = zip(codes, str(variable.attributes["flag_meanings"]).split(), strict=True)
    return f"{variable.long_name}: {', '.join(f'{code} {name}' for code, name in named)}"


def tell_times(_: Sphinx, env: object) -> None:
    """Say how long each notebook took."""
    logger = logging.getLogger(__name__)
    for name in sorted(getattr(env, "nb_metadata", {})):
        told = env.nb_metadata[name].get("exec_data")
        if told:
            logger.info("%s took %.1f s", name, told["runtime"])
