"""Tests, sweeps, searches and whole corpora on a Ray cluster (needs ``recrash[ray]``).

    import ray, recrash.ray
    ray.init("auto")
    table = recrash.ray.test(scenarios, MyPlanner, out="s3://bucket/results.parquet")

Work is cut into batches. A batch is a task without a memory: scenarios by their content, an ego, a range of numbers. Its id is
the hash of all that decides its rows, so that a batch that is done twice, because a machine was lost in the middle, changes
nothing. Batches come back as Arrow tables and are put down in their order: the same bytes as on one machine, for any number of
machines and whatever becomes of them. ``cluster=False`` does the same work in this process, without Ray.

Egos by name are run by tasks; egos that are Python objects, and MetaDrive, live in actors, one for each processor (or
``actors=``). A class is made anew for each run; another object is copied to each actor. A scenario in which an ego raises is
not run, nor is one with which a worker dies again and again: the row's ``error`` names it, and the rest goes on. Ctrl-C cancels
what is under way. A file is written whole or not at all.
"""

from __future__ import annotations

import hashlib
import itertools
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple

import fsspec
import pyarrow
import pyarrow.parquet
import ray
from ray.util.scheduling_strategies import NodeAffinitySchedulingStrategy

from recrash import _recrash
from recrash._recrash import Accounts, Scenario, Table
from recrash._show import counted, wants_progress
from recrash.errors import RecrashError
from recrash.suite import Location, as_result, in_tested, load_scenarios, read, row_of, runs, tune_one

__all__ = ["corpus", "sweep", "test", "tune"]

#: How often Ray tries a batch again whose worker or machine was lost.
RETRIES = 2
#: How often it is then sent to another actor, and how long is waited before, longer each time: until a lost machine is known. [s]
SENT_AGAIN, PAUSE_S = 2, 2.0
#: Batches under way for each processor: enough that none waits, few enough that results do not pile up.
AHEAD = 4
#: Kinds of the columns of a test, so that every batch has the same, whatever is missing in it.
TEST = pyarrow.schema(
    [
        *((name, pyarrow.string()) for name in ("scenario", "template", "crash_type", "ego", "verdict")),
        *((name, pyarrow.bool_()) for name in ("failed", "met")),
        *((name, pyarrow.string()) for name in ("cause", "termination")),
        ("duration_s", pyarrow.float64()),
        ("findings", pyarrow.string()),
        *((name, pyarrow.float64()) for name in ("min_gap_m", "closing_speed_mps", "delta_v_mps", "other_delta_v_mps")),
        *((name, pyarrow.string()) for name in ("state_hash", "error")),
    ]
)
TUNE = pyarrow.schema([*TEST, ("points", pyarrow.int64()), ("moved", pyarrow.string()), ("tuned", pyarrow.string())])
CORPUS = pyarrow.schema([("incident", pyarrow.string()), ("standing", pyarrow.string()), ("reason", pyarrow.string()), *TEST])

#: Kinds of columns of recrash's own tables, by pyarrow's types.
KINDS = {"bool": "flag", "int64": "whole", "double": "number", "string": "text"}


class Batch(NamedTuple):
    """A part of the work: what is given to the function, and what it is in words."""

    #: Hash of all that decides its rows.
    id: str
    #: What the function is given.
    given: tuple[Any, ...]
    #: What it is, for an error.
    name: str
    #: The rows that stand for it where it cannot be done; ``None`` where it must be.
    lost: Callable[[str], pyarrow.Table] | None
    #: Smaller batches of the same rows: so that what kills a worker takes nobody else with it.
    pieces: Callable[[], list[Batch]] | None = None


def test(
    scenarios: Location | Iterable[Scenario | Location],
    ego: object = None,
    *,
    profile: str | None = None,
    simulator: str | None = None,
    python: Location | None = None,
    batch: int = 64,
    actors: int | None = None,
    out: Location | None = None,
    progress: bool | None = None,
    cluster: bool = True,
) -> Table:
    """Test an ego in scenarios, as :func:`recrash.test` does: the same rows in the same order.

    ``batch`` scenarios are a task. With ``out``, a path that fsspec knows, the rows are written there as Parquet too.
    """
    loaded = load_scenarios(scenarios)
    config = (profile, simulator, None if python is None else str(python))

    def made(part: Sequence[Scenario]) -> Batch:
        name = part[0].id if len(part) == 1 else f"{part[0].id} to {part[-1].id}"
        return Batch(
            _id("test", ego, config, *(each.to_json() for each in part)),
            (part,),
            name,
            lambda why: _table([row_of(each, RecrashError(why)) for each in part], TEST),
            (lambda: [made([each]) for each in part]) if len(part) > 1 else None,
        )

    batches = [made(part) for part in _cut(loaded, batch)]
    if (ego is None or isinstance(ego, str)) and simulator != "metadrive":
        work = _Work(_test_by_name, (ego, config), None)
    else:
        work = _Work(_test_in_actor, (ego, config), _Seat)
    table: Table = _done(work, batches, "test", TEST, out, progress, cluster, actors)
    return table


def sweep(
    scenarios: Location | Iterable[Scenario | Location],
    rollouts: int,
    *,
    vary: Sequence[str] = (),
    ego: str | None = None,
    profile: str | None = None,
    seed: int = 0,
    batch: int = 8192,
    out: Location | None = None,
    progress: bool | None = None,
    cluster: bool = True,
) -> Table | None:
    """Run very many rollouts around scenarios, as :func:`recrash.sweep` does: the same rows in the same order.

    With ``out`` the rows are written there as Parquet, a row group for each batch, and nothing is kept in memory nor given.
    """
    loaded = load_scenarios(scenarios)
    config = (list(vary), ego, profile, seed)
    # What cannot vary is told here, and not by every machine.
    schema = pyarrow.table(_recrash.Points(loaded, *config).rows(0, 0)).schema
    of = _id("sweep", config, *(each.to_json() for each in loaded))
    ranges = [(begin, min(begin + batch, rollouts)) for begin in range(0, rollouts, batch)]
    batches = [Batch(_id(of, each), each, f"rollouts {each[0]} to {each[1] - 1}", None) for each in ranges]
    table: Table | None = _done(_Work(_sweep, (loaded, config), None), batches, "sweep", schema, out, progress, cluster, None)
    return table


def tune(
    scenarios: Location | Iterable[Scenario | Location],
    ego: str | None = None,
    *,
    profile: str | None = None,
    budget: int = 160,
    seed: int = 0,
    searcher: str = "cma",
    out: Location | None = None,
    progress: bool | None = None,
    cluster: bool = True,
) -> tuple[list[Scenario], Table]:
    """Search the nearest failure around each scenario, as :func:`recrash.tune` does; a scenario is a task.

    The column ``tuned`` has the tuned scenario as its file would have it.
    """
    loaded = load_scenarios(scenarios)
    config = (ego, profile, budget, seed, searcher)

    def lost(scenario: Scenario) -> Callable[[str], pyarrow.Table]:
        return lambda why: _table([{**row_of(scenario, RecrashError(why)), "tuned": scenario.to_json()}], TUNE)

    batches = [Batch(_id("tune", config, each.to_json()), (each,), each.id, lost(each)) for each in loaded]
    table: Table = _done(_Work(_tune, (config,), None), batches, "tune", TUNE, out, progress, cluster, None)
    return [_restored(each, json) for each, json in zip(loaded, table.to_dict()["tuned"], strict=True)], table


def corpus(
    files: Location | Iterable[Location] | None = None,
    ego: object = None,
    *,
    profile: str | None = None,
    where: str | None = None,
    mapping: Location | None = None,
    simulator: str | None = None,
    python: Location | None = None,
    batch: int = 32,
    actors: int | None = None,
    out: Location | None = None,
    progress: bool | None = None,
    cluster: bool = True,
) -> Table:
    """Reconstruct every incident of crash files, and test an ego in each that is told. A row an incident.

    The files are read here; ``batch`` accounts are a task, which reconstructs and tests them. ``simulator`` and ``python`` are
    those of :func:`recrash.test`.
    """
    config = (profile, simulator, None if python is None else str(python))
    accounts = read(files, where=where, mapping=mapping, profile=profile)
    incidents = accounts.table.to_dict()["incident"]
    parts = [accounts.part(begin, begin + batch) for begin in range(0, len(accounts), batch)]

    def lost(begin: int) -> Callable[[str], pyarrow.Table]:
        rows = [{"incident": each} for each in incidents[begin : begin + batch]]
        return lambda why: _table([{**row, "error": why} for row in rows], CORPUS)

    batches = []
    for number, part in enumerate(parts):
        begin = number * batch
        name = f"{incidents[begin]} to {incidents[begin + len(part) - 1]}"
        batches.append(Batch(_id("corpus", ego, config, part.__reduce__()[1][0]), (part,), name, lost(begin)))
    by_name = (ego is None or isinstance(ego, str)) and simulator != "metadrive"
    work = _Work(_corpus, (ego, config), None if by_name else _Seat)
    table: Table = _done(work, batches, "corpus", CORPUS, out, progress, cluster, actors)
    return table


def _cut(items: Sequence[Any], size: int) -> list[Sequence[Any]]:
    return [items[begin : begin + size] for begin in range(0, len(items), size)]


def _id(*parts: object) -> str:
    """Hash of all that decides a batch's rows: a Python object stands as it would be sent."""
    content = hashlib.sha256(_recrash.__version__.encode())
    for part in parts:
        told = repr(part).encode() if isinstance(part, (str, tuple, type(None))) else ray.cloudpickle.dumps(part)
        content.update(len(told).to_bytes(8, "big") + told)
    return content.hexdigest()[:24]


def _table(rows: list[dict[str, Any]], schema: pyarrow.Schema) -> pyarrow.Table:
    return pyarrow.Table.from_pylist(rows, schema=schema)


def _own(table: pyarrow.Table) -> Table:
    """Make a table of pyarrow's, whose columns came from recrash's own, one of those again."""
    kinds = [(field.name, KINDS[str(field.type)]) for field in table.schema]
    return Table._restore(kinds, table.num_rows, table.to_pydict())


def _restored(scenario: Scenario, json: str) -> Scenario:
    if json == scenario.to_json():
        return scenario
    return Scenario._restore(json, scenario.remarks, scenario.crash_type)


# What a batch is: functions of what all batches share, of a seat that an actor keeps, and of what the batch is given.


class _Seat:
    """What an actor keeps from batch to batch: a simulator that has been started."""

    def __init__(self) -> None:
        self.simulator: Any = None

    def runs(self, scenarios: Sequence[Scenario], ego: object, config: tuple[Any, ...]) -> list[Any]:
        profile, simulator, python = config
        if ego is not None and not isinstance(ego, str):
            return runs(scenarios, ego, profile=profile, simulator=simulator, progress=False)
        if self.simulator is None:
            self.simulator = _recrash.Simulator(ego, profile, simulator, python, 1)
        return [as_result(each) for each in in_tested(self.simulator.run_all, scenarios)]


def _test_by_name(shared: tuple[Any, ...], _: _Seat | None, scenarios: Sequence[Scenario]) -> pyarrow.Table:
    ego, (profile, simulator, python) = shared
    told = runs(scenarios, ego, profile=profile, simulator=simulator, python=python, threads=1, progress=False)
    return _table([row_of(each, result) for each, result in zip(scenarios, told, strict=True)], TEST)


def _test_in_actor(shared: tuple[Any, ...], seat: _Seat | None, scenarios: Sequence[Scenario]) -> pyarrow.Table:
    told = (seat or _Seat()).runs(scenarios, *shared)
    return _table([row_of(each, result) for each, result in zip(scenarios, told, strict=True)], TEST)


def _sweep(shared: tuple[Any, ...], _: _Seat | None, begin: int, end: int) -> pyarrow.Table:
    scenarios, config = shared
    return pyarrow.table(_recrash.Points(scenarios, *config).rows(begin, end, threads=1))


def _tune(shared: tuple[Any, ...], _: _Seat | None, scenario: Scenario) -> pyarrow.Table:
    made, row = tune_one(scenario, *shared[0])
    # As Table.of_rows writes what is no plain value.
    moved = None if row["moved"] is None else _recrash.Table.of_rows([{"moved": row["moved"]}]).to_dict()["moved"][0]
    return _table([{**row, "moved": moved, "tuned": made.to_json()}], TUNE)


def _corpus(shared: tuple[Any, ...], seat: _Seat | None, accounts: Accounts) -> pyarrow.Table:
    scenarios, made = accounts.reconstruct()
    by_id = {scenario.id: scenario for scenario in scenarios}
    told = (seat or _Seat()).runs(scenarios, *shared) if scenarios else []
    results = {scenario.id: row_of(scenario, result) for scenario, result in zip(scenarios, told, strict=True)}
    rows = []
    for row in made.to_dicts():
        known = results.get(row["scenario"]) if row["scenario"] in by_id else None
        # Speeds of the recorded crash have the names of those of the test.
        own = {name: row[name] for name in ("incident", "standing", "reason")}
        rows.append({**own, **(known or {"scenario": None}), "crash_type": row["crash_type"]})
    return _table(rows, CORPUS)


class _Work(NamedTuple):
    """A function, what all batches share, and what an actor keeps."""

    function: Callable[..., pyarrow.Table]
    shared: tuple[Any, ...]
    seat: type[_Seat] | None


def _done(
    work: _Work,
    batches: Sequence[Batch],
    name: str,
    schema: pyarrow.Schema,
    out: Location | None,
    progress: bool | None,
    cluster: bool,
    actors: int | None,
) -> Any:
    """Do all batches, and put their tables down in order: in a file, and in a table unless it would be a sweep's.

    On the way tables are pyarrow's; who asked gets recrash's own, as without a cluster.
    """
    tables = _on_cluster(work, batches, actors) if cluster else _here(work, batches)
    shown = wants_progress(progress)
    keeps = out is None or name != "sweep"
    rows = []
    with _parquet(out, schema) as write:
        for table in counted(tables, name, len(batches), shown):
            write(table)
            if keeps:
                rows.append(_own(table))
    return Table.concat(rows or [_own(schema.empty_table())]) if keeps else None


@contextmanager
def _parquet(out: Location | None, schema: pyarrow.Schema) -> Iterator[Callable[[pyarrow.Table], None]]:
    """A Parquet file, a row group for each table; it has its name once it is whole. Nothing without a path."""
    if out is None:
        yield lambda table: None
        return
    system, path = fsspec.core.url_to_fs(str(out))
    unfinished = path + ".unfinished"
    try:
        with system.open(unfinished, "wb") as file, pyarrow.parquet.ParquetWriter(file, schema) as writer:
            yield writer.write_table
        system.mv(unfinished, path)
    except BaseException:
        if system.exists(unfinished):
            system.rm(unfinished)
        raise


def _here(work: _Work, batches: Iterable[Batch]) -> Iterator[pyarrow.Table]:
    """Do batches in this process, one by one."""
    seat = work.seat() if work.seat else None
    for batch in batches:
        yield work.function(work.shared, seat, *batch.given)


def _answer(work_function: Callable[..., pyarrow.Table], shared: Any, seat: Any, batch_id: str, given: Any) -> Any:
    return batch_id, work_function(shared, seat, *given)


class _Actor:
    """A worker with a memory: an ego that is a Python object, or MetaDrive."""

    def __init__(self, function: Callable[..., pyarrow.Table], shared: Any, seat: type[_Seat]) -> None:
        self.function, self.shared, self.seat = function, shared, seat()

    def ready(self) -> None:
        pass

    def answer(self, batch_id: str, given: Any) -> Any:
        return _answer(self.function, self.shared, self.seat, batch_id, given)


def _on_cluster(work: _Work, batches: Sequence[Batch], actors: int | None) -> Iterator[pyarrow.Table]:
    """Do batches on the cluster, and give their tables in order. What is under way is cancelled where nobody goes on."""
    if not ray.is_initialized():
        ray.init(ignore_reinit_error=True, log_to_driver=False)
    # The machine of each processor: an actor lives there, or wherever there is room once that is lost.
    places = [node["NodeID"] for node in ray.nodes() if node["Alive"] for _ in range(int(node["Resources"].get("CPU", 0)))]
    processors = max(1, len(places))
    workers = []
    if work.seat is None:
        task = ray.remote(_answer).options(max_retries=RETRIES, num_cpus=1)
        shared = ray.put(work.shared)

        def send(batch: Batch) -> Any:
            return task.remote(work.function, shared, None, batch.id, batch.given)
    else:
        # It reserves no processor: one whose machine is lost would wait for another machine for ever.
        kind = ray.remote(_Actor)
        near = [NodeAffinitySchedulingStrategy(place, soft=True) for place in places] or ["DEFAULT"]
        homes = itertools.islice(itertools.cycle(near), min(actors or processors, len(batches)))
        made = (kind.options(scheduling_strategy=home, max_restarts=-1, max_task_retries=RETRIES) for home in homes)
        workers = [each.remote(work.function, work.shared, work.seat) for each in made]
        for worker in workers[:1]:
            _must_start(worker)
        turns = itertools.cycle(workers)

        def send(batch: Batch) -> Any:
            return next(turns).answer.remote(batch.id, batch.given)

    waiting: deque[tuple[Batch, Any]] = deque()
    to_send = iter(batches)
    try:
        for batch in itertools.islice(to_send, AHEAD * processors):
            waiting.append((batch, send(batch)))
        while waiting:
            batch, answer = waiting.popleft()
            yield _received(batch, answer, send, SENT_AGAIN)
            for following in itertools.islice(to_send, 1):
                waiting.append((following, send(following)))
    finally:
        for _, answer in waiting:
            ray.cancel(answer, force=work.seat is None)
        for worker in workers:
            ray.kill(worker)


def _must_start(worker: Any) -> None:
    """Say why where no worker can be made: an ego's module that only this machine has, for one."""
    try:
        ray.get(worker.ready.remote())
    except ray.exceptions.RayError as error:
        why = str(error).strip().splitlines()[-1]
        told = f"no worker can be started on the cluster: {why}; the package and the ego's module must be there"
        raise RecrashError(told) from error


def _received(batch: Batch, answer: Any, send: Callable[[Batch], Any], tries: int) -> pyarrow.Table:
    """A batch's table. Of a batch whose worker is lost for good what its pieces give, or what stands for it, or an exception."""
    try:
        batch_id, table = ray.get(answer)
    except ray.exceptions.RayError as error:
        if tries > 0 and isinstance(error, ray.exceptions.RayActorError):
            time.sleep(PAUSE_S * (SENT_AGAIN - tries + 1))
            return _received(batch, send(batch), send, tries - 1)
        cause = getattr(error, "cause", None)
        why = cause if isinstance(cause, RecrashError) else error
        first = str(why).strip().splitlines()[-1] if str(why).strip() else type(why).__name__
        lost = isinstance(error, (ray.exceptions.RayActorError, ray.exceptions.WorkerCrashedError, ray.exceptions.NodeDiedError))
        said = "its worker was lost, again and again" if lost else f"{type(why).__name__}: {first}"
        told = f"{batch.name}: not done on the cluster: {said}"
        if batch.lost is None or isinstance(why, RecrashError):
            raise RecrashError(told) from error
        if batch.pieces is not None:
            return pyarrow.concat_tables([_received(piece, send(piece), send, tries) for piece in batch.pieces()])
        return batch.lost(told)
    if batch_id != batch.id:
        raise RecrashError(f"{batch.name}: the cluster answered with batch {batch_id} instead of {batch.id}")
    return table
