"""A cluster of two node processes on this machine: the same bytes as one process, whatever becomes of a node."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

import pytest
from conftest import METADRIVE, case

import recrash
from recrash import RecrashError, Scenario

pytest.importorskip("ray", reason="Ray is not installed")
# Ray's own, at its start and its end.
pytestmark = pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::FutureWarning", "ignore::DeprecationWarning")


class Steady:
    """An ego with a state."""

    def reset(self, world):
        self.steps = 0

    def control(self, observation):
        self.steps += 1
        return (0.5 if self.steps % 2 else -0.5), 0.0


class Fatal(Steady):
    """Takes its process with it in one scenario."""

    def reset(self, world):
        super().reset(world)
        if world["scenario"] == "crashes-32-lead-reverses":
            os._exit(9)


class Careless(Steady):
    def reset(self, world):
        super().reset(world)
        if world["scenario"] == "crashes-32-lead-reverses":
            raise ValueError("no map")


@pytest.fixture(scope="module")
def cluster():
    import ray
    from ray.cluster_utils import Cluster

    # Workers do not have this file: egos of it are sent whole.
    ray.cloudpickle.register_pickle_by_value(sys.modules[__name__])

    memory = 100 << 20
    # A machine that is gone is missed within a second, and not within a quarter of a minute.
    soon = {"health_check_initial_delay_ms": 500, "health_check_period_ms": 250, "health_check_failure_threshold": 4}
    head = {"num_cpus": 1, "object_store_memory": memory, "include_dashboard": False, "_system_config": soon}
    made = Cluster(initialize_head=True, head_node_args=head)
    ray.init(address=made.address, log_to_driver=False, logging_level="ERROR")
    made.memory = memory
    yield made
    ray.shutdown()
    made.shutdown()


@pytest.fixture
def second_node(cluster):
    node = cluster.add_node(num_cpus=1, object_store_memory=cluster.memory)
    cluster.wait_for_nodes()
    yield node
    if node in cluster.list_all_nodes():
        cluster.remove_node(node)


@pytest.fixture
def killed_after_two(cluster, second_node, monkeypatch):
    """Kills the second node once two batches have come back; what is killed is noted."""
    import recrash.ray

    killed = []

    def counted(items, name, total, shown):
        for number, item in enumerate(items):
            if number == 1 and not killed:
                cluster.remove_node(second_node, allow_graceful=False)
                killed.append(name)
            yield item

    monkeypatch.setattr(recrash.ray, "counted", counted)
    return killed


@pytest.fixture
def scenarios(crashes):
    return recrash.load_scenarios(crashes)


@pytest.fixture(scope="module")
def designed(tmp_path_factory):
    """Scenarios that MetaDrive can hold."""
    folder = tmp_path_factory.mktemp("suite") / "s"
    options = {"profile": "paper", "budget": 3, "tune_budget": 1, "seed": 5}
    return recrash.run(folder, progress=False, until="design", **options).scenarios()


@pytest.fixture
def noted(tmp_path):
    """An interpreter with MetaDrive, and a function that gives the processes that it was started as."""
    notes, program = tmp_path / "pids", tmp_path / "python"
    program.write_text(f"#!/bin/sh\necho $$ >> '{notes}'\nexec '{METADRIVE}' \"$@\"\n")
    program.chmod(0o755)
    return program, lambda: [int(line) for line in notes.read_text().split()]


def wait_until_gone(pids):
    """Wait until none of these processes is there: they are ended with the actor that started them."""
    until = time.monotonic() + 20
    while any(Path(f"/proc/{pid}").exists() for pid in pids):
        assert time.monotonic() < until, pids
        time.sleep(0.1)


def test_tests_and_sweeps_are_those_of_one_process(second_node, scenarios, tmp_path):
    import recrash.ray

    here = {"cluster": False}
    for ego in ("idm", Steady):
        table = recrash.ray.test(scenarios, ego, batch=5, out=tmp_path / "on.parquet")
        recrash.ray.test(scenarios, ego, batch=5, out=tmp_path / "here.parquet", **here)
        assert table.to_dicts() == recrash.test(scenarios, ego).to_dicts()
        assert (tmp_path / "on.parquet").read_bytes() == (tmp_path / "here.parquet").read_bytes()
    lead = [Scenario.load(case("crashes/32-lead-reverses"))]
    vary = {"vary": ["/ego/speed_mps=5:12"], "ego": "idm", "seed": 3}
    assert recrash.ray.sweep(lead, 50, batch=20, out=tmp_path / "on.parquet", **vary) is None
    recrash.ray.sweep(lead, 50, batch=20, out=tmp_path / "here.parquet", **vary, **here)
    assert (tmp_path / "on.parquet").read_bytes() == (tmp_path / "here.parquet").read_bytes()
    assert recrash.ray.sweep(lead, 50, batch=20, **vary).to_dicts() == recrash.sweep(lead, 50, **vary).to_dicts()


@pytest.mark.parametrize("ego", ["idm", Steady])
def test_a_node_killed_in_the_middle_changes_no_byte(killed_after_two, scenarios, tmp_path, ego):
    import recrash.ray

    rows = recrash.ray.test(scenarios, ego, batch=2, out=tmp_path / "on.parquet")
    assert killed_after_two == ["test"]
    assert not any(rows.to_dict()["error"]), rows
    recrash.ray.test(scenarios, ego, batch=2, out=tmp_path / "here.parquet", cluster=False)
    assert (tmp_path / "on.parquet").read_bytes() == (tmp_path / "here.parquet").read_bytes()


needs_metadrive = pytest.mark.skipif(METADRIVE is None, reason="RECRASH_METADRIVE_PYTHON names no interpreter with MetaDrive")
PAPER = {"profile": "paper", "simulator": "metadrive"}


@needs_metadrive
def test_metadrive_workers_are_actors_that_give_what_one_machine_gives(second_node, designed, noted, tmp_path):
    import recrash.ray

    program, started = noted
    twice = [*designed, *designed[::-1]]
    options = {**PAPER, "python": program}
    table = recrash.ray.test(twice, "metadrive-idm", batch=1, out=tmp_path / "on.parquet", **options)
    workers = started()
    # One for each processor of the cluster, for all that it runs; none is left when it is done.
    assert len(workers) == 2
    wait_until_gone(workers)
    rows = table.to_dicts()
    assert not any(row["error"] for row in rows), rows
    assert rows == recrash.test(twice, "metadrive-idm", threads=1, **options).to_dicts()
    assert len(started()) == 3
    recrash.ray.test(twice, "metadrive-idm", batch=1, out=tmp_path / "here.parquet", cluster=False, **options)
    assert (tmp_path / "on.parquet").read_bytes() == (tmp_path / "here.parquet").read_bytes()


@needs_metadrive
def test_metadrive_workers_of_a_killed_node_are_done_without(killed_after_two, designed, noted, tmp_path):
    import recrash.ray

    program, started = noted
    options = {**PAPER, "python": program}
    many = designed * 4
    rows = recrash.ray.test(many, "metadrive-idm", batch=1, out=tmp_path / "on.parquet", **options)
    assert killed_after_two == ["test"]
    assert not any(rows.to_dict()["error"]), rows
    wait_until_gone(started())
    recrash.ray.test(many, "metadrive-idm", batch=1, out=tmp_path / "here.parquet", cluster=False, **options)
    assert (tmp_path / "on.parquet").read_bytes() == (tmp_path / "here.parquet").read_bytes()


@needs_metadrive
def test_a_corpus_on_metadrive_is_that_of_one_machine(second_node, noted, tmp_path):
    import recrash.ray

    program, started = noted
    options = {"ego": "metadrive-idm", "simulator": "metadrive", "python": program, "batch": 2}
    options["where"] = "road = street and month = 1 and partner = suv or report = 90101-46"
    table = recrash.ray.corpus(out=tmp_path / "on.parquet", **options)
    workers = started()
    assert len(workers) == 2
    wait_until_gone(workers)
    rows = table.to_dicts()
    # Among them: one that is not told, and one that MetaDrive cannot hold, which fails alone.
    assert any(row["scenario"] is None for row in rows)
    assert any("cannot be held by MetaDrive" in (row["error"] or "") for row in rows)
    assert len([row for row in rows if row["state_hash"]]) >= 2
    assert rows == recrash.ray.corpus(out=tmp_path / "here.parquet", cluster=False, **options).to_dicts()
    assert (tmp_path / "on.parquet").read_bytes() == (tmp_path / "here.parquet").read_bytes()


def test_where_a_worker_has_no_metadrive_it_is_told(cluster, scenarios, tmp_path):
    import recrash.ray

    with pytest.raises(RecrashError, match="no-such-python"):
        recrash.ray.test(scenarios[:2], "metadrive-idm", python="no-such-python", out=tmp_path / "t.parquet", **PAPER)
    assert list(tmp_path.iterdir()) == []


def test_a_corpus_is_reconstructed_and_tested_in_parts(cluster):
    import recrash.ray

    rows = recrash.ray.corpus(where="road = highway", ego="idm", batch=5).to_dicts()
    accounts = recrash.read(where="road = highway")
    scenarios, made = accounts.reconstruct()
    assert [row["incident"] for row in rows] == accounts.table.to_dict()["incident"]
    assert [row["standing"] for row in rows] == made.to_dict()["standing"]
    tested = {row["scenario"]: row["state_hash"] for row in recrash.test(scenarios, "idm").to_dicts()}
    assert len(rows) > 10 and tested
    assert {row["scenario"]: row["state_hash"] for row in rows if row["scenario"]} == tested


def test_searches_are_those_of_one_process(cluster, scenarios):
    import recrash.ray

    plain, table = recrash.tune(scenarios[:3], "idm", budget=6)
    tuned, rows = recrash.ray.tune(scenarios[:3], "idm", budget=6)
    assert tuned == plain
    assert [row["state_hash"] for row in rows.to_dicts()] == table.to_dict()["state_hash"]
    assert rows.to_dict()["moved"] == table.to_dict()["moved"]


def test_what_kills_its_worker_is_named_and_the_rest_goes_on(cluster, scenarios, monkeypatch):
    import recrash.ray

    monkeypatch.setattr(recrash.ray, "RETRIES", 1)
    monkeypatch.setattr(recrash.ray, "SENT_AGAIN", 0)
    few = [each for each in scenarios if each.id >= "crashes-31"][:2]
    assert "crashes-32-lead-reverses" in [each.id for each in few]
    rows = recrash.ray.test(few, Fatal, batch=4).to_dicts()
    (lost,) = [row for row in rows if row["error"]]
    assert lost["scenario"] == "crashes-32-lead-reverses"
    assert "crashes-32-lead-reverses: not done on the cluster: its worker was lost" in lost["error"]
    assert [row["scenario"] for row in rows] == [each.id for each in few]


def test_an_ego_that_raises_fails_its_scenario_alone(cluster, scenarios):
    import recrash.ray

    rows = recrash.ray.test(scenarios, Careless, batch=9).to_dicts()
    assert rows == recrash.test(scenarios, Careless).to_dicts()
    (failed,) = [row for row in rows if row["error"]]
    assert "Careless raised ValueError: no map at reset" in failed["error"]


def test_an_ego_that_workers_cannot_load_is_told(cluster, scenarios, tmp_path, monkeypatch):
    import recrash.ray

    (tmp_path / "only_here.py").write_text("def drive(_):\n    return 0.0, 0.0\n")
    monkeypatch.syspath_prepend(tmp_path)
    import only_here

    with pytest.raises(RecrashError, match=r"no worker can be started on the cluster: .*only_here.*must be there"):
        recrash.ray.test(scenarios, only_here.drive)


def test_what_cannot_be_done_is_told_and_leaves_no_file(cluster, scenarios, tmp_path, monkeypatch):
    import recrash.ray

    with pytest.raises(RecrashError, match="no ego is called `human`"):
        recrash.ray.test(scenarios, "human", out=tmp_path / "t.parquet")
    with pytest.raises(RecrashError, match="there is no such number in crashes-"):
        recrash.ray.sweep(scenarios, 10, vary=["/nobody=1:2"], out=tmp_path / "t.parquet")

    def stops(items, name, total, shown):
        yield next(items)
        raise KeyboardInterrupt

    monkeypatch.setattr(recrash.ray, "counted", stops)
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        recrash.ray.test(scenarios, "idm", batch=1, out=tmp_path / "t.parquet")
    assert time.monotonic() - begun < 20
    assert list(tmp_path.iterdir()) == []


def test_an_id_is_of_the_content(scenarios):
    import recrash.ray

    one = recrash.ray._id("test", "idm", (None, None), scenarios[0].to_json())
    assert one == recrash.ray._id("test", "idm", (None, None), scenarios[0].to_json())
    assert one != recrash.ray._id("test", "reference", (None, None), scenarios[0].to_json())
    assert one != recrash.ray._id("test", "idm", (None, None), scenarios[1].to_json())
