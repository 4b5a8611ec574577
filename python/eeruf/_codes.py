"""Arrays of codes that can be compared with the codes' names."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from eeruf import _eeruf


class Codes(np.ndarray):
    """An int8 array of indices into ``_names``: ``codes == "accepted"`` is true where a code stands for that name."""

    _names: ClassVar[tuple[str, ...]] = ()

    def _code(self, other: object) -> object:
        if not isinstance(other, str):
            return other
        if other not in self._names:
            expected = " or ".join(f'"{name}"' for name in self._names)
            raise _eeruf.EerufError(f"compared with {other!r}; expected {expected}")
        return self._names.index(other)

    def __eq__(self, other: object) -> Any:
        """Compare with a name, or with codes."""
        return np.asarray(self) == self._code(other)

    def __ne__(self, other: object) -> Any:
        """Compare with a name, or with codes."""
        return np.asarray(self) != self._code(other)

    def __reduce__(self) -> Any:
        """Pickle as a plain array; its owner adds the names again."""
        return np.asarray(self).__reduce__()

    def __reduce_ex__(self, protocol: Any) -> Any:
        """Pickle as a plain array, out of band where the protocol can."""
        return np.asarray(self).__reduce_ex__(protocol)


class Kinds(Codes):
    """Indices into ``eeruf.KINDS``."""

    _names = _eeruf.KINDS


class Causes(Codes):
    """Indices into ``eeruf.typing.CAUSES``."""

    _names = _eeruf.CAUSES
