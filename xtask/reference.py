"""Writes the reference of the installed package `eeruf` as HTML: `python reference.py FOLDER`.

A public name that pdoc cannot find ends it with an error.
"""

import sys
import warnings

import eeruf
from pdoc.__main__ import cli

# What comes on first use must stand in its module, and modules and types among its names, or pdoc does not see them.
eeruf.__all__ += ["experiments", "logs", "nav", "plot", "sim", "tables", "typing"]
for name in eeruf.__all__:
    setattr(eeruf, name, getattr(eeruf, name))
eeruf.typing.__all__ = [name for name in vars(eeruf.typing) if name[0] != "_" and name not in ("annotations", "TYPE_CHECKING")]

warnings.simplefilter("error")
# Of the names that only checkers of types know, it shows the text.
warnings.filterwarnings("ignore", "Failed to run TYPE_CHECKING code|Error parsing type annotation")
cli(["--docformat", "google", "--output-directory", sys.argv[1], "eeruf"])
