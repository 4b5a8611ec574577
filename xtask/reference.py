"""Writes the reference of the installed package `eeruf` as HTML: `python reference.py FOLDER`.

A public name that pdoc cannot find ends it with an error.
"""

import sys
import warnings

import eeruf
from pdoc.__main__ import cli

# Names imported on first use must be set in their module, and modules and types named in __all__, for pdoc to see them.
eeruf.__all__ += ["experiments", "logs", "nav", "plot", "sim", "tables", "typing"]
for name in eeruf.__all__:
    setattr(eeruf, name, getattr(eeruf, name))
eeruf.typing.__all__ = [name for name in vars(eeruf.typing) if name[0] != "_" and name not in ("annotations", "TYPE_CHECKING")]

warnings.simplefilter("error")
# For names that only type checkers know, pdoc shows the text.
warnings.filterwarnings("ignore", "Failed to run TYPE_CHECKING code|Error parsing type annotation")
cli(["--docformat", "google", "--output-directory", sys.argv[1], "eeruf"])
