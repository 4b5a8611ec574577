"""The figures of a simulation, and the methods of all results."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, ClassVar

if TYPE_CHECKING:
    from eeruf._eeruf import _MethodName


class _Documented:
    """A docstring with those of the fields, which only the source has: ``help`` shows them."""

    def __init__(self, text: str | None) -> None:
        self.text = text

    def __get__(self, _: object, kind: type) -> str:
        import ast
        import inspect

        (tree,) = ast.parse(inspect.getsource(kind)).body
        body = getattr(tree, "body", [])
        fields = [
            f"    {ast.unparse(one.target)}: {' '.join(str(of.value.value).split())}"
            for one, of in zip(body, body[1:])
            if isinstance(one, ast.AnnAssign) and isinstance(of, ast.Expr) and isinstance(of.value, ast.Constant)
        ]
        return (
            "\n".join([inspect.cleandoc(self.text or ""), "", "Attributes:", *fields, ""])
            if fields
            else self.text or ""
        )


def document(names: dict[str, object]) -> None:
    """Let ``help`` of the results among these show what their fields are."""
    for kind in names.values():
        if isinstance(kind, type) and issubclass(kind, Result) and kind.__module__ == names["__name__"]:
            kind.__doc__ = _Documented(kind.__doc__)  # type: ignore[assignment]


def _plain(value: object) -> object:
    """Convert to numbers, strings, lists and dicts."""
    if (to_dict := getattr(value, "to_dict", None)) is not None:
        return to_dict()
    if isinstance(value, dict):
        return {name: _plain(of) for name, of in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    tolist = getattr(value, "tolist", None)
    return value if tolist is None else tolist()


class Result:
    """Methods of all results."""

    def to_dict(self) -> dict[str, object]:
        """Return the fields by their names, with results as dicts and arrays as lists, for JSON and data frames.

        Example:
            >>> from eeruf.typing import Spread
            >>> Spread(0.0, 0.1, 0.5, (0.0, 0.2), (0.4, 0.6), 0.2, (0.1, 0.3)).to_dict()["median_95"]
            [0.0, 0.2]

        """
        return {name.name: _plain(getattr(self, name.name)) for name in fields(self)}  # type: ignore[arg-type]


def _said(value: object, title: str) -> str:
    """Format a figure as a cell: a spread's median with its 95 % interval, in percent if the title says so."""
    scale, digits = (100.0, 1) if title.endswith("%") else (1.0, 2 if title.endswith("m/s") else 0)
    if value is None:
        return "-"
    if (spread := getattr(value, "median_95", None)) is not None:
        low, high = (f"{scale * bound:.{digits}f}" for bound in spread)
        return f"{scale * value.median:.{digits}f} ({low} to {high})"  # type: ignore[attr-defined]
    return f"{scale * value:.{digits}f}"  # type: ignore[operator]


class Table(Result):
    """A result that prints as a table with a row for each method: as text, and in a notebook."""

    _titles: ClassVar[dict[str, str]]
    """The figures that are shown, and the titles of their columns."""

    def _rows(self) -> list[list[str]]:
        methods = self.methods.items()  # type: ignore[attr-defined]
        rows = [
            [name, *(_said(getattr(of, key), title) for key, title in self._titles.items())] for name, of in methods
        ]
        columns = zip(self._titles.values(), list(zip(*rows))[1:])
        titles = [title + (" (95 %)" if any(cell.endswith(")") for cell in cells) else "") for title, cells in columns]
        return [["method", *titles], *rows]

    def __str__(self) -> str:
        """Return the table as text; ``to_dict`` has all figures."""
        rows = self._rows()
        wide = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
        lines = ("  ".join([row[0].ljust(wide[0]), *map(str.rjust, row[1:], wide[1:])]).rstrip() for row in rows)
        return chr(10).join(lines)

    def _repr_html_(self) -> str:
        from html import escape

        lines = [
            "".join(f"<{cell}>{escape(of)}</{cell}>" for of in row)
            for row, cell in zip(self._rows(), ("th", *["td"] * len(self._rows())))
        ]
        return "<table>" + "".join(f"<tr>{line}</tr>" for line in lines) + "</table>"


@dataclass(frozen=True)
class Summary(Result):
    """The figures of a method that are always reported together. Shares are fractions of 1.

    Example:
        >>> from eeruf import sim
        >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
        >>> summary = sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100).summary()
        >>> summary.readings, summary.wrong_of_all < 0.01, summary.to_dict()["method"]
        (800, True, 'eeruf')

    """

    method: _MethodName
    """The method, one of ``eeruf.sim.METHODS``."""
    readings: int
    """Number of readings."""
    accepted: int
    """Number of accepted readings."""
    wrong_of_all: float
    """Share of all readings that were accepted and wrong: the harmful ones."""
    crosstalk_of_all: float
    """The part of ``wrong_of_all`` that foreign or stale sound caused."""
    confirmed_wrong_of_all: float
    """The part of ``wrong_of_all`` that was confirmed, not only tentative."""
    wrong_of_accepted: float | None
    """Share of the accepted readings that were wrong; None if none was accepted."""
    rejected: float
    """Share of all readings that were not accepted."""
    good_lost: float | None
    """Share of the good readings that were not accepted; None if no reading was good."""
    wrong_before_filter: float
    """Share of all readings that would have been wrong without any filter."""
    belief_right: float
    """Share of the time in which the latest accepted reading, at most 0.6 s old, is right."""
    unknown: float
    """Share of the time without an accepted reading that is at most 0.6 s old."""
    phantom: float
    """Share of the time in which the latest accepted reading is foreign sound."""
    too_far: float
    """Share of the time in which a sensor's latest accepted reading is its own later echo, or silence despite one."""
    faint: float
    """Share of the time in which a sensor's latest accepted reading is its own nearer echo, faint but real."""
    right_echoes_per_s: float
    """Accepted echoes per second that were right, over all sensors."""
    age_ms: float
    """Median age of a sensor's last accepted reading, in milliseconds."""
    age_p99_ms: float
    """99th percentile of the age of a sensor's last accepted reading, in milliseconds."""
    readings_per_s: float
    """Accepted readings per second, over all sensors."""
    starved: int
    """Number of sensors that had fewer than 5 % of their readings accepted."""
    blind: int
    """Number of sensors that were right in fewer than 5 % of their firings."""
    starved_in_part: int
    """Number of starved sensors that read right in one phase and not in another."""


document({**globals()})
