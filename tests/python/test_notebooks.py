"""The notebooks run from top to bottom, and the claims of their texts about figures hold."""

from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

NOTEBOOKS = Path(__file__).parents[2] / "docs" / "notebooks"

CLAIMS = {
    "design-a-ring": """
assert found.proven and report.ok and report.separation_us >= 2 * report.max_t_delta_us
assert 12 * 36_000 == 432_000 and found.value_us < 100_000
assert all(table.verify(t_delta_us=999, min_interval_us=15_000, layout=layout).ok for layout in ("line", "ring"))
""",
    # The upper picture's robot arrives, by readings that were accepted.
    "drive-a-robot-yourself": """
world, track = drive("eeruf")
assert not world.robots[0].touches and math.hypot(7.3 - track[-1][0], 2.8 - track[-1][1]) < 0.3
assert [ax.get_title().split(":")[0] for ax in axes] == ["eeruf", "conventional"]
""",
    "the-papers-experiments": """
wrong = {name: figures.wrong_of_all.median for name, figures in set_one.methods.items()}
assert wrong["eeruf"] < 0.06 and wrong["conventional"] > 0.3
assert wrong["comparison"] > 0.8 * wrong["conventional"]
lost = {name: figures.good_lost.median for name, figures in set_one.methods.items()}
assert lost["eeruf"] > 0.05 > lost["comparison"]
phantoms = {name: figures.phantom_echoes for name, figures in shared.methods.items()}
assert phantoms["conventional"] > 20 * phantoms["eeruf"]
own = eeruf.experiments.set_two(seeds=12, methods=methods)
assert all(figures.finished >= 8 for figures in own.methods.values())
""",
    "why-crosstalk-fools-a-ring": """
one = conventional.sensor == 1
wrong, steps = conventional.is_wrong()[one], np.abs(np.diff(conventional.t_echo_us[one]))
assert wrong.mean() > 0.9 and (steps[wrong[1:]] < 500).mean() > 0.95
one = alternating.sensor == 1
believed = alternating.is_accepted[one]
assert (believed & (alternating.cause[one] != eeruf.typing.CAUSES.index("own"))).sum() == 0 < believed.sum()
between = alternating.fired_s[one][believed]
assert 2.0 < between.min() and between.max() < 60.0 and abs(alternating.reference_us[one][0] - 8_000) < 100
foreign = (alternating.cause[one] == eeruf.typing.CAUSES.index("crosstalk")) & ~believed
assert foreign.mean() > 0.2 and np.abs(np.diff(alternating.t_echo_us[one][foreign])).max() > 1_000
assert len(paths) > 20
""",
}


@pytest.mark.parametrize("file", sorted(NOTEBOOKS.glob("*.ipynb")), ids=lambda file: str(file.stem))
def test_a_notebook_runs_and_its_claims_hold(file: Path) -> None:
    notebook = nbformat.read(file, as_version=4)
    notebook.cells.append(nbformat.v4.new_code_cell(CLAIMS[file.stem]))
    client = NotebookClient(
        notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(NOTEBOOKS)}}
    )
    client.execute()
    pictures = [output for cell in notebook.cells for output in cell.get("outputs", []) if "data" in output]
    assert any("image/png" in picture["data"] for picture in pictures)
