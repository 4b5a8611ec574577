"""All figures on one sheet, for visual inspection."""

import importlib.util
import warnings
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).parents[2]


def test_every_figure_fits_a_column_light_and_dark() -> None:
    spec = importlib.util.spec_from_file_location("sheet", Path(__file__).with_name("sheet.py"))
    assert spec is not None
    assert spec.loader is not None
    sheet = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sheet)
    file = ROOT / "target" / "python" / "figures.png"
    with warnings.catch_warnings():
        # Matplotlib warns about a layout without room.
        warnings.simplefilter("error", UserWarning)
        warnings.filterwarnings("ignore", message="Animation was deleted")
        assert sheet.draw(file) == 2 * len(sheet.figures()) >= 20
    assert Image.open(file).width == 4 * round(3.5 * sheet.DPI)
