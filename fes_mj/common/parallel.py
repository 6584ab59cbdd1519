"""Independent tasks on this machine's cores (joblib, loky) or on a Dask cluster, through one function."""

import multiprocessing
import os
import signal
import sys
import threading
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, ExitStack
from typing import Any, NamedTuple, TypeVar

from fes_mj.common.errors import InputError, require_extra, require_within

Task = TypeVar("Task")
TaskResult = TypeVar("TaskResult")
SCHEDULER_PATIENCE = "5s"  # for a scheduler to answer


class Workers(NamedTuple):
    """Where tasks run: processes on this machine, or the Dask scheduler at an address (tcp://host:port)."""

    jobs: int = 1
    cluster: str | None = None


HERE = Workers()  # this process


def run_tasks(
    function: Callable[[Task], TaskResult], tasks: Sequence[Task], workers: Workers = HERE
) -> Iterator[tuple[int, TaskResult]]:
    """Yield (index, function(task)) as tasks finish, in any order.

    A task should take seconds. Raises InputError for a scheduler that does not answer, for fewer than one job, and if
    a local worker process dies (a cluster repeats the lost task elsewhere).
    """
    require_within("jobs", workers.jobs, 1)
    if workers.jobs == 1 and not workers.cluster:
        yield from ((index, function(task)) for index, task in enumerate(tasks))
        return
    joblib = require_extra("optimize", "joblib")
    # after an interruption joblib counts the tasks it has lost
    warnings.filterwarnings("ignore", r"\d+ tasks have been successfully executed", UserWarning)
    # and so does the process that removes its shared files when this one ends at a signal, which takes these options
    sys.warnoptions.append("ignore:resource_tracker:UserWarning")
    with _backend(joblib, workers):
        parallel = joblib.Parallel(return_as="generator_unordered", batch_size=1)
        try:
            yield from parallel(joblib.delayed(_numbered)(function, index, task) for index, task in enumerate(tasks))
        except RuntimeError as error:
            if type(error).__name__ == "TerminatedWorkerError":
                raise InputError(
                    "a worker process died (killed, or out of memory); what was finished is kept: start it again, with "
                    "fewer jobs"
                ) from None
            raise


def _numbered(function: Callable[[Task], TaskResult], index: int, task: Task) -> tuple[int, TaskResult]:
    return index, function(task)


def _follow(parent: int) -> None:
    """In a worker: leave Ctrl-C to the parent, and end when the parent is gone, even if it was killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def watch() -> None:
        if sys.platform == "win32":  # where a process keeps the number of a parent that is gone
            if process := multiprocessing.parent_process():
                process.join()
        else:
            while os.getppid() == parent:
                time.sleep(0.5)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _backend(joblib: Any, workers: Workers) -> AbstractContextManager[Any]:
    if not workers.cluster:
        here: AbstractContextManager[Any] = joblib.parallel_config(
            "loky", n_jobs=workers.jobs, inner_max_num_threads=1, initializer=_follow, initargs=(os.getpid(),)
        )
        return here
    distributed = require_extra("cluster", "distributed")
    try:
        client = distributed.Client(workers.cluster, timeout=SCHEDULER_PATIENCE, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as error:
        raise InputError(
            f"cluster {workers.cluster}: no Dask scheduler answers there ({type(error).__name__}); "
            "give the tcp://host:port that `dask scheduler` prints"
        ) from None
    stack = ExitStack()  # the client is closed last
    stack.callback(client.close)
    stack.enter_context(joblib.parallel_config(backend="dask", client=client))
    return stack
