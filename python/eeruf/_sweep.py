"""Many cases at once, on this machine or on others."""

from __future__ import annotations

import functools
import os
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

    Returns:
        One result for each case. The results do not depend on the executor.

    Raises:
        ArgumentError: the function cannot be called, the cases are not several, or an executor or ``progress`` that is none.
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
    if executor is not None:
        return _run(function, todo, executor, report)
    if _is_own(function):
        return _run_on_threads(function, todo, report)
    return _run_on_processes(function, todo, report)


def _is_own(function: Callable[..., Any]) -> bool:
    """Whether it is a function or a method of eeruf's, which lets go of the interpreter lock."""
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
    function: Callable[[Case], Result], cases: list[Case], report: Callable[[float | None, str], Any] | None
) -> list[Result]:
    """Run on threads of our own, which end with us."""
    # Not before it is needed: that is most of what importing eeruf would cost.
    from concurrent.futures import ThreadPoolExecutor

    stop = _Stop()
    with ThreadPoolExecutor(max_workers=_workers(cases)) as threads:
        try:
            return _run(functools.partial(_until_stopped, stop, function), cases, threads, report)
        except BaseException:
            stop.stop()
            raise


def _run_on_processes(
    function: Callable[[Case], Result], cases: list[Case], report: Callable[[float | None, str], Any] | None
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
            return _run(function, cases, processes, report)
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
) -> list[Result]:
    import queue

    # Not `as_completed`, which waits for ever for a future that an executor cancels by itself, as Dask does when a worker dies.
    ended: queue.SimpleQueue[Future[Result]] = queue.SimpleQueue()
    futures = [executor.submit(function, case) for case in cases]
    try:
        for future in futures:
            future.add_done_callback(ended.put)
        for done in range(1, len(futures) + 1):
            # An error is raised as it comes.
            ended.get().result()
            if report is not None:
                report(done / len(futures), f"{done} of {len(futures)}")
    finally:
        # After an error or Ctrl-C nobody waits for the rest.
        for future in futures:
            future.cancel()
    return [future.result() for future in futures]
