"""Slips that a type checker must find: mypy and pyright refuse each line below, and `test_types.py` counts them."""

# ruff: noqa
import eeruf
import numpy as np
from eeruf import plot, sim, tables

scene = sim.Scene([[5, 2, -5, 2]])
eeruf.design(8, 999, 15_000, 36_000, layout="circle")
eeruf.design(8.0, 999, 15_000, 36_000)
eeruf.design(8, 999, 15_000, 36_000, layout=[(0, 1, 2)])
tables.TABLE_I_D.verify(999, criterion="strict")
eeruf.WaitSearch(4, 40_000, 8_000, 1_000, t_delta_us=999).best("speed")
eeruf.EchoFilter(4, 500).push(0, 9_000.5)
eeruf.EchoFilter(4, 500).push(0, None).kind == "acepted"
sim.Robot((0, 0), 8, 0.26, 0.3)
sim.Robot((0, 0, 0), 8, 0.26, 0.3, "hcsr04")
sim.Robot((0, 0, 0), 8, 0.26, 0.3, gain="quadratic")
sim.Scene([[5, 2, -5, 2]], materials="velvet")
sim.Scene([[5, 2, -5, 2]], temperature=20.0)
sim.simulate(scene, "eruf")
sim.simulate(scene, periods="100")
sim.simulate(scene).is_accepted()
sim.simulate(scene).summary().wrong_of_al
sim.simulate(scene).summary().accepted = 0
eeruf.experiments.set_one(2).methods[3]
eeruf.experiments.set_one(2).method
sim.simulate(scene).paths["emiter"]
sim.simulate(scene).period.foo
eeruf.experiments.set_one(2, methods=["eruf"])
eeruf.experiments.set_two(2, second_robot="left")
plot.timing(scene)
eeruf.desing(8, 999, 15_000, 36_000)
scene.seed = 4
eeruf.design(8, 999, 15_000, 36_000, phases=5)
eeruf.Schedule.congruence(8, 60_000, 240)
eeruf.EchoTracker(8)
eeruf.design(8, 999, 15_000, 36_000).width_us
eeruf.read_log("log.csv", range_unit="km")
