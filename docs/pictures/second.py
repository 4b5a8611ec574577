"""Draws a second of readings under three ways of firing: python docs/pictures/second.py [FILE.svg] (eeruf and matplotlib needed)."""

import sys
from pathlib import Path

import eeruf
import matplotlib.pyplot as plt
import numpy as np

HERE = Path(__file__).parent
WAYS = {"blocking": "one by one, as sketches fire", "conventional": "all within 100 ms, every echo believed", "flow": "flow"}
FROM_S, RIGHT, WRONG, REJECTED = 20.0, "#1a7f4b", "#d1242f", "#b5bac0"

plt.rcParams.update({"svg.hashsalt": "eeruf", "svg.fonttype": "none", "font.size": 9, "font.family": "sans-serif"})
scene = eeruf.sim.Scene.read_toml(HERE.parents[1] / "scenes" / "meeting-hc-sr04.toml")
figure, axes = plt.subplots(1, 3, figsize=(10, 2.9), sharey=True, layout="constrained")
for ax, (method, title) in zip(axes, WAYS.items()):
    all_readings = eeruf.sim.simulate(scene, method=method, periods=600, seed=1)
    all_readings = all_readings[all_readings.robot == 0]
    shown = (all_readings.emitted_s >= FROM_S) & (all_readings.emitted_s < FROM_S + 1)
    time, sensor = all_readings.emitted_s[shown] - FROM_S, all_readings.sensor[shown] + 1
    accepted, wrong = all_readings.is_accepted[shown], all_readings.is_wrong()[shown]
    for of, style in [
        (~accepted, {"marker": "o", "facecolors": "none", "edgecolors": REJECTED, "s": 14, "label": "rejected"}),
        (accepted & ~wrong, {"marker": "o", "color": RIGHT, "s": 16, "label": "believed, right"}),
        (accepted & wrong, {"marker": "X", "color": WRONG, "s": 22, "label": "believed, wrong"}),
    ]:
        ax.scatter(time[of], sensor[of], linewidths=0.9, **style)
    right = np.bincount(all_readings.sensor[all_readings.is_accepted & ~all_readings.is_wrong()], minlength=8)
    fired = np.bincount(all_readings.sensor, minlength=8)
    for blind in np.flatnonzero(right < 0.05 * fired):
        ax.axhspan(blind + 0.6, blind + 1.4, color=WRONG, alpha=0.12, linewidth=0)
        ax.text(1.01, blind + 1, "blind", va="center", fontsize=7, color=WRONG)
    count = int(np.sum(accepted & ~wrong))
    ax.set_title(f"{title}\n{count} right, {int(np.sum(accepted & wrong))} wrong in this second", fontsize=9)
    ax.set(xlim=(0, 1), ylim=(8.6, 0.4), xlabel="seconds", yticks=range(1, 9))
    ax.spines[["top", "right"]].set_visible(False)
axes[0].set_ylabel("sensor")
handles, labels = axes[2].get_legend_handles_labels()
figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False)
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else HERE / "second.svg", metadata={"Date": None})
