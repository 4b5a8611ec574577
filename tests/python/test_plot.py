"""Figures show what they are given, in the axes they are given."""

from pathlib import Path

import eeruf
import matplotlib
import numpy as np
import pytest
from eeruf import experiments, plot, sim, tables

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
    # Each sensor is a line, and each robot a mark.
    assert len(ax.lines) == len(scene.walls) + len(paths) + 8 + 1 + 2
    ax = plt.subplots()[1]
    assert plot.readings(sim.simulate(scene, periods=40), sensor=4, ax=ax) is ax
    assert sum(np.size(line.get_xdata()) for line in ax.lines[1:]) == 40


def test_methods_are_drawn_worst_first_in_percent() -> None:
    result = eeruf.experiments.set_one(seeds=2, readings=400, methods=["eeruf", "conventional"])
    ax = plot.methods(result)
    assert [label.get_text() for label in ax.get_yticklabels()] == ["conventional", "eeruf"]
    spread = result.methods["conventional"].wrong_of_all
    assert spread is not None
    assert ax.patches[0].get_width() == pytest.approx(100 * spread.median)  # type: ignore[attr-defined]
    with pytest.raises(eeruf.EerufError, match="figure = 'beauty'; expected one of age_ms"):
        plot.methods(result, figure="beauty")
    with pytest.raises(eeruf.EerufError, match=r"names = \['loud'\]; expected some of eeruf, conventional"):
        plot.methods(result, names=["loud"])


def test_set_two_is_drawn_by_counts_and_shares() -> None:
    found = experiments.set_two(seeds=2, methods=["eeruf", "conventional"], pilot="shared")
    ax = plot.methods(found, figure="finished")
    assert [patch.get_width() for patch in ax.patches] == [2, 0]  # type: ignore[attr-defined]
    assert ax.get_xlabel() == "courses finished"
    ax = plot.methods(found, figure="rejected")
    assert ax.get_xlabel() == "readings not accepted (%)"
    assert ax.patches[0].get_width() == pytest.approx(100 * found.methods["eeruf"].rejected)  # type: ignore[attr-defined]


def test_a_course_shows_poles_grid_track_and_the_last_place() -> None:
    import matplotlib.pyplot as plt

    found = experiments.set_two(seeds=2, methods=["conventional", "eeruf"], second_robot="ahead")
    run = found.runs["conventional"][0]
    ax = plt.subplots()[1]
    assert plot.course(found, method="conventional", course=20_000, ax=ax) is ax
    drawn = {line.get_label(): line for line in ax.lines}
    assert drawn["pole"].get_xdata() == pytest.approx(run.poles[:, 0])
    track = drawn["track, outline every second"]
    assert (track.get_xdata()[-1], track.get_ydata()[-1]) == tuple(run.track[-1, 1:3])  # type: ignore[index]
    assert np.array_equal(np.asarray(ax.collections[0].get_array()), run.grid[:, 2])
    circles = [patch for patch in ax.patches if isinstance(patch, matplotlib.patches.Circle)]
    assert [circle.get_center() for circle in circles] == [pytest.approx((9.4, 5.3))]
    ending = {"contact": "touched something", "finished": "finished", "time_out": "not through"}[run.ending]
    assert ax.get_title(loc="left").startswith(f"conventional, course 20000: {ending} ")


def test_a_run_alone_is_drawn_and_other_values_are_refused() -> None:
    found = experiments.set_two(seeds=1, methods=["eeruf"])
    assert plot.course(found.runs["eeruf"][0]).get_title(loc="left").startswith("course 20000: finished after")
    for arguments, message in [
        ({"method": "loud"}, "method = 'loud'; expected one of eeruf"),
        ({"course": 7}, "course = 7; expected 20000 to 20000"),
    ]:
        with pytest.raises(eeruf.EerufError, match=message):
            plot.course(found, **arguments)  # type: ignore[arg-type]
    with pytest.raises(eeruf.EerufError, match="expected what eeruf"):
        plot.course({"methods": {}})  # type: ignore[arg-type]


def test_ways_of_foreign_sound_lead_from_sender_to_believer() -> None:
    scene = sim.Scene.from_toml(eeruf.example("scenes/two-hc-sr04.toml"))
    ax = plot.scene(scene, readings=sim.simulate(scene, "simultaneous", periods=20))
    (way,) = [line for line in ax.lines if len(np.asarray(line.get_xdata())) == 3]
    x, y, heading = scene.robots[0].pose
    at = [
        (x + dx * np.cos(heading) - dy * np.sin(heading), y + dx * np.sin(heading) + dy * np.cos(heading))
        for dx, dy, _ in scene.robots[0].sensor_poses
    ]
    corners = np.column_stack([way.get_xdata(), way.get_ydata()])
    assert corners[[0, -1]] == pytest.approx(np.array([at[1], at[0]]))
    assert corners[1][1] == pytest.approx(0.6)
    assert ax.get_title(loc="left").startswith("simultaneous: 20 of 40 readings")


def test_readings_that_were_believed_and_wrong_are_marked() -> None:
    scene = sim.Scene.from_toml(eeruf.example("scenes/two-hc-sr04.toml"))
    readings = sim.simulate(scene, "simultaneous", periods=20)
    drawn = {line.get_label(): np.size(line.get_xdata()) for line in plot.readings(readings, sensor=0).lines}
    assert (drawn["accepted, and wrong"], drawn["accepted"], drawn["not accepted"]) == (20, 0, 0)


def test_a_film_shows_sound_and_the_readings_that_come_of_it() -> None:
    scene = sim.Scene.from_toml(eeruf.example("scenes/two-hc-sr04.toml"))
    film = plot.animation(scene, sim.simulate(scene, "simultaneous", periods=4), frames=30)
    dots, discs = [], set()
    for frame in range(30):
        sound, heard, _ = film._func(frame)  # type: ignore[attr-defined]
        dots.append(len(sound.get_offsets()))
        discs |= {tuple(colour) for colour in np.round(heard.get_edgecolor(), 2)}
    # Nothing is on its way at first or last, two sounds are at times, and one sensor is right while the other is not.
    assert (dots[0], max(dots), dots[-1], len(discs)) == (2, 2, 0, 2)
    film._draw_was_started = True  # type: ignore[attr-defined]
    with pytest.raises(eeruf.EerufError, match="no readings of 2 periods from there"):
        plot.animation(scene, sim.simulate(scene, "simultaneous", periods=4), first=7)
    elsewhere = sim.Scene.from_toml(eeruf.example("scenes/alcove.toml"))
    with pytest.raises(eeruf.EerufError, match="expected their own scene"):
        plot.animation(scene, sim.simulate(elsewhere, periods=4))


def test_speeds_are_drawn_by_method() -> None:
    sweep = experiments.speed_sweep([0.75, 1.0], seeds=1, methods=["eeruf", "conventional"])
    ax = plot.methods(sweep)
    assert [line.get_label() for line in ax.lines] == ["eeruf", "conventional"]
    assert list(np.asarray(ax.lines[0].get_ydata())) == [100 * step.finished_of_all["eeruf"] for step in sweep.steps]
    with pytest.raises(eeruf.EerufError, match="expected what eeruf"):
        plot.methods({"steps": []})  # type: ignore[arg-type]


def test_every_figure_is_legible_on_a_dark_background() -> None:
    import matplotlib.pyplot as plt
    from matplotlib.colors import to_rgb

    with plt.style.context("dark_background"):
        ax = plot.readings(sim.simulate(sim.Scene.read_toml(ALCOVE), "conventional", periods=40))
        for line in ax.lines:
            assert sum(to_rgb(line.get_color())) > 1.0, line.get_label()
