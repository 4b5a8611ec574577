"""Figures with matplotlib, which the extra ``eeruf[plot]`` installs.

Every function draws into ``ax``, or into new axes if there are none, and returns the axes. Sensors are printed from 1, as in the
paper; arguments count them from 0, as everywhere in code. Colours follow the background, so that a dark style works; they also
differ in grey and to the colour-blind. For a column of a paper, pass axes 3.5 inches wide.
"""

from eeruf.plot._animation import animation
from eeruf.plot._course import course
from eeruf.plot._methods import methods
from eeruf.plot._readings import readings
from eeruf.plot._scene import scene
from eeruf.plot._timing import timing

__all__ = ["animation", "course", "methods", "readings", "scene", "timing"]
