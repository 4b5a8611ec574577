"""Types of eeruf's results, for annotations, and guards for its literals. Only eeruf itself needs to create them.

Example:
    >>> from eeruf.typing import SetOne, is_kind
    >>> def best(table: SetOne) -> str:
    ...     return min(table.methods, key=lambda name: table.methods[name].wrong_of_all.median)
    >>> is_kind("accepted"), is_kind("acepted")
    (True, False)

"""

from __future__ import annotations

from typing import TYPE_CHECKING

from eeruf._eeruf import (
    CAUSES as CAUSES,
    KINDS,
    METHODS,
    BatchState as BatchState,
    FiredReading as FiredReading,
    Paths as Paths,
    ReadingBlocks as ReadingBlocks,
    WaitTables as WaitTables,
)
from eeruf._records import (
    Blind as Blind,
    RobotState as RobotState,
    Steering as Steering,
    Violation as Violation,
)
from eeruf._results import (
    AlcoveRun as AlcoveRun,
    Difference as Difference,
    Latency as Latency,
    NewStep as NewStep,
    PlacingRun as PlacingRun,
    Run as Run,
    SetOne as SetOne,
    SetOneFigures as SetOneFigures,
    SetThree as SetThree,
    SetThreeBrief as SetThreeBrief,
    SetThreeFigures as SetThreeFigures,
    SetThreeGroup as SetThreeGroup,
    SetTwo as SetTwo,
    SetTwoFigures as SetTwoFigures,
    SpeedStep as SpeedStep,
    SpeedSweep as SpeedSweep,
    Spread as Spread,
)
from eeruf._summary import (
    Summary as Summary,
)
from eeruf.experiments import (
    Scenes as Scenes,
)
from eeruf.logs import (
    Checked as Checked,
    Crosstalk as Crosstalk,
    Diagnosis as Diagnosis,
    Judged as Judged,
    Surveyed as Surveyed,
)

if TYPE_CHECKING:
    from typing_extensions import TypeGuard

    from eeruf._eeruf import _Kind, _MethodName


def is_kind(name: str) -> TypeGuard[_Kind]:
    """Return true if a name is a kind of readings; type checkers then narrow its type.

    Args:
        name: a string from elsewhere, such as a log.

    Example:
        >>> from eeruf.typing import is_kind
        >>> is_kind("accepted"), is_kind("acepted")
        (True, False)

    """
    return name in KINDS


def is_method(name: str) -> TypeGuard[_MethodName]:
    """Return true if a name is that of a method; type checkers then narrow its type.

    Args:
        name: a string from elsewhere, such as a command line.

    Example:
        >>> from eeruf.typing import is_method
        >>> is_method("eeruf"), is_method("eruf")
        (True, False)

    """
    return name in METHODS
