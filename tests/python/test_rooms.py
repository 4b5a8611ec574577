"""Rooms in which a ring is judged, and the way of firing that is recommended."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import eeruf
import pytest
from eeruf import experiments, sim

ANY: Any = experiments
RING = Path(__file__).parents[2] / "rings" / "hc-sr04-8.toml"


def test_recommendation_is_the_programs() -> None:
    """The recommendation has the same words and figures."""
    answer = experiments.recommend(RING, places=1, first=7)
    words = ["study", str(RING), "--places", "1", "--first", "7", "--json"]
    printed = subprocess.run([sys.executable, "-m", "eeruf", *words], capture_output=True, check=True).stdout
    assert answer == json.loads(printed)
    ways = [way["way"] for kind in answer["kinds"] for way in kind["best"]]
    assert answer["kinds"][0]["kind"] == "one by one" and answer["recommended"] in [*ways, "sequential"]


def test_own_rooms_are_scenes_by_name() -> None:
    """Own rooms give the program's answer for the same rooms from files."""
    alcove = RING.parents[1] / "scenes" / "alcove-hc-sr04.toml"
    answer = experiments.recommend(RING, rooms={alcove.stem: sim.Scene.read_toml(alcove)}, places=1, all_ways=True)
    words = ["study", str(RING), "--rooms", str(alcove), "--places", "1", "--json"]
    printed = subprocess.run([sys.executable, "-m", "eeruf", *words], capture_output=True, check=False).stdout
    assert answer == json.loads(printed)
    assert list(answer["kinds"][0]["best"][0]["rooms"]) == [alcove.stem]


def test_rooms_are_scenes_of_the_rings_robot() -> None:
    """The robot has its modules in place, is the same for the same number, and drives if requested."""
    one, other = experiments.rooms(RING, 5, 2, kind="clutter")
    assert (one.seed, other.seed, one.height) == (5, 6, other.height)
    assert one.robots[0].sensors == 8 and one.robots[0].module == "hc-sr04"
    again = experiments.rooms(RING, 5, 1, kind="clutter")[0]
    readings = [sim.simulate(scene, "sequential", 5).t_echo_us.tobytes() for scene in (one, again)]
    assert readings[0] == readings[1]
    assert len(experiments.rooms(RING, n=1, kind="meeting")[0].robots) == 2
    driving = experiments.rooms(RING, n=1, kind="corridor", driving=True)[0]
    assert sim.simulate(driving, "sequential", 30).x_m.std() > 0


def test_wrong_arguments_are_named(tmp_path: Path) -> None:
    """Errors have thing, value and expectation."""
    with pytest.raises(eeruf.EerufError, match=r'kind = .*kitchen.*; expected .*"corridor"'):
        ANY.rooms(RING, kind="kitchen")
    with pytest.raises(eeruf.EerufError, match=r"none\.toml: No such file"):
        experiments.recommend("none.toml")
    with pytest.raises(eeruf.EerufError, match="places = 0; expected a whole number from 1 to 1000"):
        experiments.recommend(RING, places=0)
    empty = sim.Scene([[5, 2, -5, 2]])
    for rooms, said in [
        ([empty], "rooms = .*; expected scenes by name, a dict"),
        ({}, "rooms = {}; expected scenes by name, a dict"),
        ({"hall": 1}, "rooms = .*; expected scenes by name, a dict"),
    ]:
        with pytest.raises(eeruf.EerufError, match=said):
            ANY.recommend(RING, rooms=rooms)
    with pytest.raises(eeruf.EerufError, match="a scene of 0 robots; expected 1 or more"):
        experiments.recommend(RING, rooms={"hall": empty})
    mower = tmp_path / "mower.toml"
    mower.write_text(RING.with_name("mower-8-and-4.toml").read_text().partition("poses = ")[0])
    with pytest.raises(eeruf.EerufError, match="does not say where its sensors are"):
        experiments.recommend(mower)
