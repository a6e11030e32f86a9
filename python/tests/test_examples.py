"""Drivers of others behind the interface of egos."""

from __future__ import annotations

import sys

import pytest
from conftest import case

import recrash
from recrash import Scenario

EXAMPLES = case("x").parents[1] / "python" / "examples"


@pytest.fixture
def highway_idm(monkeypatch):
    pytest.importorskip("highway_env", reason="highway-env is not installed")
    monkeypatch.syspath_prepend(EXAMPLES)
    import highway_idm

    yield highway_idm.HighwayIdm
    del sys.modules["highway_idm"]


@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::UserWarning")
def test_highway_envs_idm_drives_the_route_and_brakes_for_who_is_ahead(highway_idm):
    lead = Scenario.load(case("crashes/32-lead-reverses"))
    run = lead.run(highway_idm)
    assert run.ego == "py:HighwayIdm"
    coasting = lead.run(lambda _: (0.0, 0.0))
    # It sees the lead and brakes: it is slower at the end than one that coasts, and stays on its lane.
    assert run.states[-2, 0, 6] < 0.0
    assert abs(run.states[-1, 0, 3]) <= abs(coasting.states[-1, 0, 3])
    rows = recrash.test([lead, Scenario.load(case("acts/02-curve"))], highway_idm).to_dicts()
    assert not any(row["error"] for row in rows)
    assert "off_road" not in [row["termination"] for row in rows]
