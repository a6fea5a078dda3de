"""Settings of the documentation: pages, notebooks kept as Python files, docstrings, the registry's tables."""

import os

from sphinx.application import Sphinx
from sphinx.util import logging

import fdspec
from fdspec import variables

# Kernels inherit it, and would then keep the figures of pyplot to themselves.
os.environ.pop("MPLBACKEND", None)

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
exclude_patterns = ["_build", "conf.py", "jupyter_execute", "notebooks/README.md"]

html_theme = "furo"
html_title = f"fdspec {release}"

myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
# A changelog repeats its headings.
suppress_warnings = ["myst.xref_ambiguous"]

# docs/notebooks is a link to notebooks/, whose files are Python in the percent format; each runs in a kernel
# of its own, and a cell that fails fails the build. So does a notebook that takes longer than this, s. The
# gallery is read first, and pays for kernels that were never compiled: so cells may take longer.
NOTEBOOK_LIMIT = 120
nb_custom_formats = {".py": ["jupytext.reads", {"fmt": "py:percent"}]}
nb_execution_mode = "force"
nb_execution_timeout = 600
nb_execution_raise_on_error = True
nb_merge_streams = True

autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
python_use_unqualified_type_names = True
napoleon_google_docstring = False
napoleon_use_rtype = False


def setup(app: Sphinx) -> None:
    """Hook the tables and the clock in."""
    app.connect("source-read", fill_tables)
    app.connect("env-updated", check_times)


def fill_tables(_: Sphinx, docname: str, source: list[str]) -> None:
    """Put the registry's tables into the page on files."""
    if docname == "schema":
        for name in ("CUBE", "BUILDING_CUBE", "HISTORY"):
            source[0] = source[0].replace(f"@@{name}@@", table_of(getattr(variables, name)))


def table_of(registry: variables.Registry) -> str:
    """Return a registry as a table of Markdown."""
    rows = [
        f"| `{one.name}` | {', '.join(one.dims) or '-'} | {one.units or '-'} | {one.dtype} | {meaning(one)} |"
        for one in registry.values()
    ]
    return "\n".join(["| name | over | units | type | meaning |", "|---|---|---|---|---|", *rows])


def meaning(variable: variables.Variable) -> str:
    """Return the long name and what flags mean."""
    codes = variable.attributes.get("flag_values")
    if codes is None:
        return variable.long_name
    named = zip(codes, str(variable.attributes["flag_meanings"]).split(), strict=True)
    return f"{variable.long_name}: {', '.join(f'{code} {name}' for code, name in named)}"


def check_times(_: Sphinx, env: object) -> None:
    """Warn, which fails the build, of each notebook that took too long; say how long all took."""
    logger = logging.getLogger(__name__)
    for name in sorted(getattr(env, "nb_metadata", {})):
        told = env.nb_metadata[name].get("exec_data")
        if not told:
            continue
        logger.info("%s took %.1f s", name, told["runtime"])
        if name.startswith("notebooks/") and told["runtime"] > NOTEBOOK_LIMIT:
            logger.warning("%s took %.0f s, over the limit of %d s", name, told["runtime"], NOTEBOOK_LIMIT)
