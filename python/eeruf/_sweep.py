"""Many cases at once, on this machine or on others."""

from __future__ import annotations

import functools
import os
import pickle
from types import ModuleType
from typing import TYPE_CHECKING, Any, Callable, TypeVar

from eeruf._eeruf import ArgumentError, _Stop, _until_stopped

if TYPE_CHECKING:
    from collections.abc import Iterable
    from concurrent.futures import Executor, Future

Case = TypeVar("Case")
Result = TypeVar("Result")


def sweep(
    function: Callable[[Case], Result],
    cases: Iterable[Case],
    executor: Executor | None = None,
    progress: bool | Callable[[float | None, str], Any] | None = None,
    *,
    folder: str | os.PathLike[str] | None = None,
) -> list[Result]:
    """Call a function for every case, in parallel, and return the results in the order of the cases.

    The first error ends it as soon as it comes, whichever case it is of, and so does Ctrl-C; cases that run on an executor of yours
    are not waited for.

    Args:
        function: of one case. With processes it must be importable, not a lambda.
        cases: what to call it with. Schedules, scenes, robots and readings pickle, so they may be cases and results.
        executor: any ``concurrent.futures.Executor``, such as Dask's ``Client.get_executor()``. By default, on each core one thread
            for eeruf's own functions, which let go of the interpreter lock, alone or in a ``functools.partial``; one process for all
            others, which may hold it. These processes start afresh (``forkserver`` or ``spawn``), since a fork of a program
            with threads may hang: a script that starts them needs ``if __name__ == "__main__":``.
        progress: True for a bar (tqdm if it is installed), or a callable that takes the share done and a text.

        folder: where each result is kept in a file of its own as soon as it comes (a pickle: read only what you trust). A sweep
            that was killed goes on from there when it is called again with the same function and cases: what is lost is what was
            under way. The folder is made if need be.

    Returns:
        One result for each case. The results do not depend on the executor, nor on how often the sweep was begun again.

    Raises:
        ArgumentError: the function cannot be called, the cases are not several, an executor or ``progress`` that is none, or a
            folder with results of another sweep.
        OSError: the folder cannot be written to.
        Exception: whatever the function raises first.

    Example:
        >>> import eeruf
        >>> from concurrent.futures import ThreadPoolExecutor
        >>> def period_us(sensors):
        ...     return eeruf.design(sensors, t_delta_us=999, min_interval_us=15_000, window_us=36_000).value_us
        >>> with ThreadPoolExecutor() as threads:
        ...     eeruf.sweep(period_us, [4, 8], executor=threads)
        [62000, 66000]

    """
    if not callable(function):
        raise ArgumentError(f"function = {function!r}; expected something to call with one case")
    report = _reporter(progress)
    try:
        one_by_one = iter(cases)
    except TypeError:
        raise ArgumentError(f"cases = {cases!r:.60}; expected several cases") from None
    todo = list(one_by_one)
    if executor is not None and not callable(getattr(executor, "submit", None)):
        raise ArgumentError(f"executor = {executor!r:.60}; expected a concurrent.futures.Executor")
    kept = None if folder is None else _Kept(folder, function, todo)
    if executor is not None:
        return _run(function, todo, executor, report, kept)
    if _is_own(function):
        return _run_on_threads(function, todo, report, kept)
    return _run_on_processes(function, todo, report, kept)


class _Kept:
    """The results of a sweep in the files of a folder, one for each case."""

    def __init__(self, folder: str | os.PathLike[str], function: Callable[..., Any], cases: list[Any]) -> None:
        """Read what is there, and refuse what is of another sweep."""
        try:
            self.folder = os.fspath(folder)
        except TypeError:
            raise ArgumentError(f"folder = {folder!r:.60}; expected the path of a folder, or None") from None
        os.makedirs(self.folder, exist_ok=True)
        self.cases = [self._plain((_named(function), len(cases), case)) for case in cases]
        self.results = {index: self._read(index) for index in range(len(cases)) if os.path.exists(self._path(index))}

    @staticmethod
    def _plain(value: Any) -> Any:
        return pickle.loads(pickle.dumps(value))

    def _path(self, index: int) -> str:
        return os.path.join(self.folder, f"{index:06}.pickle")

    def _read(self, index: int) -> Any:
        path = self._path(index)
        with open(path, "rb") as file:
            try:
                asked, result = pickle.load(file)
            except Exception as error:
                expected = "a result of a sweep; delete it, and its case runs again"
                raise ArgumentError(f"{path}: {type(error).__name__}: {error}; expected {expected}") from error
        if not _equal(asked, self.cases[index]):
            expected = f"one of the case {self.cases[index]!r:.60}; use another folder for another sweep"
            raise ArgumentError(f"{path}: a result of the case {asked!r:.60}; expected {expected}")
        return result

    def keep(self, index: int, result: Any) -> None:
        """Write a result; a file is there whole or not at all."""
        path = self._path(index)
        with open(path + ".part", "wb") as file:
            pickle.dump((self.cases[index], result), file)
            file.flush()
            os.fsync(file.fileno())
        os.replace(path + ".part", path)


def _named(function: Any) -> Any:
    """Return a function's name, and the arguments that it is bound to."""
    if isinstance(function, functools.partial):
        return _named(function.func), function.args, function.keywords
    return getattr(function, "__module__", ""), getattr(function, "__qualname__", type(function).__qualname__)


def _equal(one: Any, other: Any) -> bool:
    """Return true if two cases are the same; arrays by their elements."""
    if isinstance(one, (tuple, list)) and type(one) is type(other):
        return len(one) == len(other) and all(map(_equal, one, other))
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_equal(one[key], other[key]) for key in one)
    try:
        return bool(one == other) or pickle.dumps(one) == pickle.dumps(other)
    except ValueError:
        return pickle.dumps(one) == pickle.dumps(other)


def _is_own(function: Callable[..., Any]) -> bool:
    """Return true for a function or a method of eeruf's, which lets go of the interpreter lock."""
    while isinstance(function, functools.partial):
        function = function.func
    owner = getattr(function, "__self__", None)
    module = function.__module__ if owner is None or isinstance(owner, ModuleType) else type(owner).__module__
    return isinstance(module, str) and (module == "eeruf" or module.startswith("eeruf."))


def _reporter(progress: Any) -> Callable[[float | None, str], Any] | None:
    if progress is None or progress is False:
        return None
    if progress is True:
        from eeruf._progress import bar

        return bar()
    if callable(progress):
        found: Callable[[float | None, str], Any] = progress
        return found
    raise ArgumentError(f"progress = {progress!r}; expected None, True or a callable (share, text)")


def _workers(cases: list[Case]) -> int:
    return max(1, min(len(cases), os.cpu_count() or 1))


def _run_on_threads(
    function: Callable[[Case], Result],
    cases: list[Case],
    report: Callable[[float | None, str], Any] | None,
    kept: _Kept | None,
) -> list[Result]:
    """Run on threads of our own, which end with us."""
    # Not before it is needed: that is most of what importing eeruf would cost.
    from concurrent.futures import ThreadPoolExecutor

    stop = _Stop()
    with ThreadPoolExecutor(max_workers=_workers(cases)) as threads:
        try:
            return _run(functools.partial(_until_stopped, stop, function), cases, threads, report, kept)
        except BaseException:
            stop.stop()
            raise


def _run_on_processes(
    function: Callable[[Case], Result],
    cases: list[Case],
    report: Callable[[float | None, str], Any] | None,
    kept: _Kept | None,
) -> list[Result]:
    """Run on processes of our own, which end with us."""
    import multiprocessing
    from concurrent.futures import ProcessPoolExecutor

    # A forked child has the locks of threads that it does not have.
    method = "forkserver" if "forkserver" in multiprocessing.get_all_start_methods() else "spawn"
    context = multiprocessing.get_context(method)
    others = set(multiprocessing.active_children())
    with ProcessPoolExecutor(max_workers=_workers(cases), mp_context=context) as processes:
        try:
            return _run(function, cases, processes, report, kept)
        except BaseException:
            # A case may take hours, and what was handed to a process can no longer be cancelled.
            for process in set(multiprocessing.active_children()) - others:
                process.terminate()
            raise


def _run(
    function: Callable[[Case], Result],
    cases: list[Case],
    executor: Executor,
    report: Callable[[float | None, str], Any] | None,
    kept: _Kept | None,
) -> list[Result]:
    import queue

    found: dict[int, Any] = dict(kept.results) if kept is not None else {}
    # Not `as_completed`, which waits for ever for a future that an executor cancels by itself, as Dask does when a worker dies.
    ended: queue.SimpleQueue[Future[Result]] = queue.SimpleQueue()
    futures = {executor.submit(function, case): index for index, case in enumerate(cases) if index not in found}
    try:
        for future in futures:
            future.add_done_callback(ended.put)
        for _ in futures:
            future = ended.get()
            # An error is raised as it comes.
            result, index = future.result(), futures[future]
            found[index] = result
            if kept is not None:
                kept.keep(index, result)
            if report is not None:
                report(len(found) / len(cases), f"{len(found)} of {len(cases)}")
    finally:
        # After an error or Ctrl-C the rest is not waited for.
        for future in futures:
            future.cancel()
    return [found[index] for index in range(len(cases))]
