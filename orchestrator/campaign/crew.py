"""Who flies the landings: workers of dask.distributed, each a process with units of its own that it keeps between landings.

    base = Base.read(find_scenario("apollo11_zupp_twin"), overrides=["soil*.friction=0.5"], changes={"stop_time": 3.0})
    with Crew(workers=2) as crew:                                  # or Crew(scheduler="tcp://host:8786"): the rest is the same
        landings = crew.fly_all(base, [["lander.roll_start=0.1"], ["lander.roll_start=0.2"]])       # in their order
        for name, landing in crew.fly(base, {"a": [...], "b": [...]}.items()):                      # as they end
            landing.outcome, landing.outputs["strokes_m.+Z.left"], landing.error

An entry is what `orchestrator run SCENARIO --set` takes, so every landing can be flown alone. A landing that cannot be flown is one with
`error`; the others go on. A worker that dies is replaced and its landings are flown again by another; those that DEATHS workers died
over are flown once more alone, and one that kills as many then is given up, and says so.
"""

from __future__ import annotations

import logging
from collections.abc import Hashable, Iterable, Iterator, Sequence
from contextlib import suppress
from itertools import islice
from os import cpu_count
from types import TracebackType
from typing import TYPE_CHECKING, Any, TypeVar

from orchestrator.campaign.landing import Base, Landing, land
from orchestrator.campaign.outputs import NOT_FLOWN
from orchestrator.errors import RunError, UserError
from orchestrator.interruption import unheard

if TYPE_CHECKING:
    from distributed import Client, Future, LocalCluster

Name = TypeVar("Name", bound=Hashable)
DEATHS = 3
AHEAD = 4
"""Landings handed to the scheduler for each worker: enough that none waits, few enough that a long campaign does not fill its memory."""
ANSWERS_WITHIN = 15.0
"""s, for a scheduler to be found and a worker to join."""
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")


class Crew:
    """Workers of our own, or, with `scheduler`, those of a cluster that stands already. A context: the workers end with it."""

    def __init__(self, workers: int = 0, scheduler: str | None = None) -> None:
        """workers: processes of our own, 0: one a core. scheduler: address of a dask scheduler."""
        self.workers, self.scheduler = workers or cpu_count() or 1, scheduler
        self._cluster: LocalCluster | None = None
        self._client: Client | None = None

    def __enter__(self) -> Crew:
        import dask
        from distributed import Client

        dask.config.set({"distributed.scheduler.allowed-failures": DEATHS - 1})
        for chatty in ("distributed", "tornado"):       # a lost worker is no news to the user: its landings are flown again
            logging.getLogger(chatty).setLevel(logging.CRITICAL)
        with unheard():
            if self.scheduler is None:
                self._cluster = self._own_cluster()
            try:
                self._client = Client(self._cluster or self.scheduler, timeout=ANSWERS_WITHIN, set_as_default=False)
                self._client.wait_for_workers(1, timeout=ANSWERS_WITHIN)
            except (OSError, TimeoutError, ValueError) as error:
                self.close()
                raise UserError(_unreachable(self.scheduler, error)) from None
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close(at_once=kind is not None)

    def close(self, at_once: bool = False) -> None:
        """End the workers that are ours, `at_once` whatever they are at; another's cluster is only left."""
        client, cluster, self._client, self._cluster = self._client, self._cluster, None, None
        if cluster is not None and at_once:
            for nanny in list(cluster.workers.values()):
                with suppress(AttributeError):
                    nanny.process.process.kill()
        for ending in (client, cluster):
            if ending is not None:
                with suppress(OSError, TimeoutError):
                    ending.close(timeout=ANSWERS_WITHIN)

    def fly_all(self, base: Base, landings: Sequence[Sequence[str]]) -> list[Landing]:
        """The landings in their order."""
        found = dict(self.fly(base, enumerate(landings)))
        return [found[i] for i in range(len(landings))]

    def fly(self, base: Base, landings: Iterable[tuple[Name, Sequence[str]]]) -> Iterator[tuple[Name, Landing]]:
        """Each as it ends, under its name. `landings` is drawn from as workers become free."""
        from distributed import as_completed

        client = self._connected()
        left, flying = iter(landings), {}
        suspects: list[tuple[Name, tuple[str, ...]]] = []
        done = as_completed(loop=client.loop)

        def send(count: int) -> None:
            for name, overrides in islice(left, count):
                future = client.submit(land, base, tuple(overrides), pure=False)
                flying[future] = (name, tuple(overrides))
                done.add(future)

        try:
            send(AHEAD * max(1, self.size))
            while flying:
                future: Future = next(done)
                name, overrides = flying.pop(future)
                landing = _landing(future)
                send(1)
                if landing is None:
                    suspects.append((name, overrides))
                else:
                    yield name, landing
            for name, overrides in suspects:  # a worker takes those that wait for it along when it dies: alone the guilty one shows
                future = client.submit(land, base, overrides, pure=False)
                flying[future] = (name, overrides)
                landing = _landing(future)
                del flying[future]
                died = f"{base.where}: {DEATHS} workers died over this landing; fly it alone to see why"
                yield name, landing or Landing(overrides, NOT_FLOWN, False, died)
        finally:
            if flying:
                client.cancel(list(flying), force=True)

    @property
    def size(self) -> int:
        """Workers there are at present."""
        return len(self._connected().scheduler_info(n_workers=-1)["workers"])

    def _connected(self) -> Client:
        if self._client is None:
            raise RuntimeError("a crew is a context: with Crew() as crew")
        return self._client

    def _own_cluster(self) -> LocalCluster:
        from distributed import LocalCluster

        options: dict[str, Any] = {"processes": True, "threads_per_worker": 1, "memory_limit": 0, "dashboard_address": ":0"}
        return LocalCluster(n_workers=self.workers, silence_logs=logging.CRITICAL, env=ONE_THREAD, **options)


def _landing(future: Future) -> Landing | None:
    """A future's landing, waited for; None where the workers it was given to died."""
    from distributed import CancelledError, KilledWorker

    try:
        landing: Landing = future.result()
        return landing
    except KilledWorker:
        return None
    except CancelledError:
        raise RunError("the scheduler was lost; what was flown is kept: start the cluster, then give the same command again") from None


def _unreachable(scheduler: str | None, error: Exception) -> str:
    said = str(error).splitlines()[0] if str(error) else type(error).__name__
    if scheduler is None:
        return f"no worker could be started ({said}); give a smaller --workers"
    waited = f"no scheduler with a worker answers within {ANSWERS_WITHIN:g} s ({said})"
    return f"--scheduler {scheduler}: {waited}; start one, or leave the option out"
