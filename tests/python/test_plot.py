"""Figures show what they are given, in the axes they are given."""

from pathlib import Path

import eeruf
import matplotlib
import numpy as np
import pytest
from eeruf import experiments, plot, sim, tables
from matplotlib.collections import LineCollection

matplotlib.use("Agg")
ALCOVE = Path(__file__).parents[2] / "scenes" / "alcove.toml"


def test_the_timing_marks_every_firing_of_both_phases() -> None:
    ax = plot.timing(tables.TABLE_I_D)
    marks = np.array([path.get_extents().x0 for lines in ax.collections for path in lines.get_paths()])
    expected = [*tables.TABLE_I_D.t_fire_a_us, *(100_000 + us for us in tables.TABLE_I_D.t_fire_b_us)]
    assert sorted(1000 * marks) == pytest.approx(sorted(expected))


def test_figures_draw_into_the_axes_they_are_given() -> None:
    import matplotlib.pyplot as plt

    scene = sim.Scene.read_toml(ALCOVE)
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
    with pytest.raises(eeruf.ArgumentError, match="figure = 'beauty'; expected one of age_ms"):
        plot.methods(result, figure="beauty")
    with pytest.raises(eeruf.ArgumentError, match=r"names = \['loud'\]; expected some of eeruf, conventional"):
        plot.methods(result, names=["loud"])


def test_set_two_is_drawn_by_counts_and_shares() -> None:
    found = experiments.set_two(seeds=2, methods=["eeruf", "conventional"])
    ax = plot.methods(found, figure="finished")
    assert [patch.get_width() for patch in ax.patches] == [2, 0]  # type: ignore[attr-defined]
    assert ax.get_xlabel() == "courses finished"
    ax = plot.methods(found, figure="rejected")
    assert ax.get_xlabel() == "readings not accepted (%)"
    assert ax.patches[0].get_width() == pytest.approx(100 * found["methods"]["eeruf"]["rejected"])  # type: ignore[attr-defined]


def test_a_course_shows_poles_grid_track_and_the_last_place() -> None:
    import matplotlib.pyplot as plt

    found = experiments.set_two(seeds=2, methods=["conventional", "eeruf"], second_robot="ahead")
    run = found.runs["conventional"][1]
    ax = plt.subplots()[1]
    assert plot.course(found, method="conventional", course=1, ax=ax) is ax
    drawn = {line.get_label(): line for line in ax.lines}
    assert drawn["pole"].get_xdata() == pytest.approx(run.poles[:, 0])
    track = drawn["track, outline every second"]
    assert (track.get_xdata()[-1], track.get_ydata()[-1]) == tuple(run.track[-1, 1:3])  # type: ignore[index]
    assert np.array_equal(np.asarray(ax.collections[0].get_array()), run.grid[:, 2])
    circles = [patch for patch in ax.patches if isinstance(patch, matplotlib.patches.Circle)]
    assert [circle.get_center() for circle in circles] == [pytest.approx((9.4, 5.3))]
    assert ax.get_title(loc="left").startswith("conventional, course 1: touched something after")


def test_a_run_alone_is_drawn_as_well_and_what_is_none_is_refused() -> None:
    found = experiments.set_two(seeds=1, methods=["eeruf"])
    assert plot.course(found.runs["eeruf"][0]).get_title(loc="left").startswith("course 0: finished after")
    for arguments, message in [
        ({"method": "loud"}, "method = 'loud'; expected one of eeruf"),
        ({"course": 7}, "course = 7; expected 0 to 0"),
    ]:
        with pytest.raises(eeruf.ArgumentError, match=message):
            plot.course(found, **arguments)  # type: ignore[arg-type]
    with pytest.raises(eeruf.ArgumentError, match="expected what eeruf"):
        plot.course({"methods": {}})  # type: ignore[arg-type]


def test_the_timing_of_many_phases_marks_every_firing_of_each() -> None:
    schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
    ax = plot.timing(schedule, window_us=36_000)
    fires = next(lines for lines in ax.collections if isinstance(lines, LineCollection))
    drawn = sorted(float(segment[0][0]) for segment in fires.get_segments())
    assert drawn == pytest.approx(sorted((schedule.t_fire_us / 1e3).ravel().tolist()))
    assert len(ax.patches) == 2 * 8 * 11
    assert ax.get_xlim() == (0, 60)
