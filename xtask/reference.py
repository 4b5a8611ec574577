"""Writes the reference of the installed package `eeruf` as HTML: `python reference.py FOLDER`.

A public name that pdoc cannot find ends it with an error.
"""

import sys
import warnings

import eeruf.sim
from pdoc.__main__ import cli

# What comes on first use must stand in its module, or pdoc does not see it.
for module in (eeruf, eeruf.sim):
    for name in module.__all__:
        setattr(module, name, getattr(module, name))

warnings.simplefilter("error")
# Of the names that only checkers of types know, it shows the text.
warnings.filterwarnings("ignore", "Failed to run TYPE_CHECKING code|Error parsing type annotation")
cli(["--docformat", "google", "--output-directory", sys.argv[1], "eeruf"])
