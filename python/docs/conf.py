"""Pages of the Python package: `sphinx-build -W python/docs OUT`, in an environment that has the package and its extras."""

import recrash

project = "recrash for Python"
author = "the recrash maintainers"
release = version = recrash.__version__
extensions = ["myst_parser", "sphinx.ext.autodoc"]
html_theme = "alabaster"
# The guide's tables speak of files of the repository, which are no pages here.
myst_enable_extensions = ["colon_fence"]
# The extension module writes Markdown, with one tick for code.
default_role = "code"
autodoc_member_order = "bysource"
autodoc_typehints = "none"
autodoc_mock_imports = ["stable_baselines3"]
nitpicky = False
