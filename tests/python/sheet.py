"""Draw every figure at the width of a paper's column, light and dark, on one sheet: `python tests/python/sheet.py FILE.png`."""

from __future__ import annotations

import argparse
import functools
import io
from collections.abc import Callable
from pathlib import Path

import eeruf
import matplotlib
import matplotlib.pyplot as plt
from eeruf import experiments, plot, sim, tables
from matplotlib.axes import Axes
from PIL import Image

# The width of a column, in inches.
COLUMN = 3.5
DPI = 150
ACROSS = 4
SCENES = Path(__file__).parents[2] / "scenes"


@functools.lru_cache
def figures() -> list[tuple[str, float, Callable[[Axes], object]]]:
    """Return every figure by its name, with its height in inches."""
    two = sim.Scene.from_toml(eeruf.example("scenes/two-hc-sr04.toml"))
    alcove = sim.Scene.read_toml(SCENES / "alcove.toml")
    conventional = sim.simulate(alcove, "conventional", periods=120)
    paths = alcove.paths((0.0, 0.2), [(0.1, 0.2)], 2)
    room = sim.Scene(
        [[-3, -2, 3, -2], [3, -2, 3, 2], [3, 2, -3, 2], [-3, 2, -3, -2]],
        open=[1],
        poles=[[1.5, 0.5, 0.1], [0.5, -1.0, 0.05]],
        materials=["smooth", "smooth", "soft", "painted"],
        robots=[sim.Robot((-1.5, 0.3, 0.4), 8, 0.3, 0.3), sim.Robot((1, -1, 2), 4, 0.5, 0.2)],
    )
    one = experiments.set_one(seeds=8, readings=800, methods=["sequential", "conventional", "eeruf", "flow"])
    courses = experiments.set_two(seeds=6, methods=["conventional", "eeruf"], second_robot="ahead")
    sweep = experiments.speed_sweep([0.75, 1.0, 1.5], seeds=6, methods=["conventional", "comparison", "eeruf"])
    film = sim.simulate(two, "simultaneous", periods=4)

    def a_picture_of_the_film(ax: Axes) -> None:
        moving = plot.animation(two, film, frames=40, ax=ax)
        moving._draw_was_started = True  # type: ignore[attr-defined]
        moving._func(1)  # type: ignore[attr-defined]

    return [
        ("timing", 3.0, lambda ax: plot.timing(tables.TABLE_I_D, window_us=36_000, ax=ax)),
        ("scene", 3.0, lambda ax: plot.scene(room, ax=ax)),
        ("scene, paths", 3.0, lambda ax: plot.scene(alcove, paths, source=(0.0, 0.2), receivers=[(0.1, 0.2)], ax=ax)),
        ("scene, who fooled whom", 3.0, lambda ax: plot.scene(alcove, readings=conventional, ax=ax)),
        ("readings", 2.6, lambda ax: plot.readings(conventional, sensor=4, ax=ax)),
        ("methods, Set I", 2.2, lambda ax: plot.methods(one, ax=ax)),
        ("methods, Set II", 2.2, lambda ax: plot.methods(courses, figure="finished", ax=ax)),
        ("speeds", 2.6, lambda ax: plot.methods(sweep, ax=ax)),
        ("course", 3.0, lambda ax: plot.course(courses, method="conventional", ax=ax)),
        ("animation", 3.0, a_picture_of_the_film),
    ]


def draw(file: Path) -> int:
    """Draw the sheet, light figures first, and return how many pictures it has."""
    pictures = []
    for style in ("default", "dark_background"):
        with plt.style.context(style):
            for name, height, paint in figures():
                figure, ax = plt.subplots(figsize=(COLUMN, height), layout="constrained")
                paint(ax)
                figure.text(0.0, 0.0, name, fontsize=5, alpha=0.6)
                stored = io.BytesIO()
                figure.savefig(stored, dpi=DPI)
                plt.close(figure)
                pictures.append(Image.open(stored).convert("RGB"))
    width = max(picture.width for picture in pictures)
    rows = [pictures[at : at + ACROSS] for at in range(0, len(pictures), ACROSS)]
    heights = [max(picture.height for picture in row) for row in rows]
    sheet = Image.new("RGB", (ACROSS * width, sum(heights)), "grey")
    top = 0
    for row, height in zip(rows, heights):
        for column, picture in enumerate(row):
            sheet.paste(picture, (column * width, top))
        top += height
    file.parent.mkdir(parents=True, exist_ok=True)
    sheet.save(file)
    return len(pictures)


if __name__ == "__main__":
    matplotlib.use("Agg")
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path)
    print(draw(parser.parse_args().file), "pictures")
