"""Figures show what they are given, in the axes they are given."""

from pathlib import Path

import eeruf
import matplotlib
import numpy as np
import pytest
from eeruf import plot, sim, tables

matplotlib.use("Agg")
ALCOVE = Path(__file__).parents[2] / "scenes" / "alcove.toml"


def test_the_timing_marks_every_firing_of_both_phases() -> None:
    ax = plot.timing(tables.TABLE_I_D)
    marks = np.array([path.get_extents().x0 for lines in ax.collections for path in lines.get_paths()])
    expected = [*tables.TABLE_I_D.t_fire_a_us, *(100_000 + us for us in tables.TABLE_I_D.t_fire_b_us)]
    assert sorted(1000 * marks) == pytest.approx(sorted(expected))


def test_figures_draw_into_the_axes_they_are_given() -> None:
    import matplotlib.pyplot as plt

    scene = sim.Scene.from_toml(ALCOVE)
    paths = scene.paths((0.0, 0.2), [(0.1, 0.2)], 2)
    ax = plt.subplots()[1]
    assert plot.scene(scene, paths, source=(0.0, 0.2), receivers=[(0.1, 0.2)], ax=ax) is ax
    assert len(ax.lines) == len(scene.walls) + len(paths) + 2
    ax = plt.subplots()[1]
    assert plot.readings(sim.simulate(scene, periods=40), sensor=4, ax=ax) is ax
    assert sum(np.size(line.get_xdata()) for line in ax.lines[1:]) == 40


def test_methods_are_drawn_worst_first_in_percent() -> None:
    result = eeruf.experiments.set_one(seeds=2, readings=400, methods=["eeruf", "conventional"])
    ax = plot.methods(result)
    assert [label.get_text() for label in ax.get_yticklabels()] == ["conventional", "eeruf"]
    median = result["methods"]["conventional"]["wrong_of_all"]["median"]
    assert ax.patches[0].get_width() == pytest.approx(100 * median)  # type: ignore[attr-defined]
    with pytest.raises(KeyError, match="beauty"):
        plot.methods(result, figure="beauty")
