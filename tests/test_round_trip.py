"""There and back: what was exported to OpenSCENARIO, imported and simulated is the rollout of the original."""

import json
from pathlib import Path

from exports import Export, run


def test_every_scenario_comes_back_with_the_state_hash_it_had(recrash: str, exports: list[Export], tmp_path: Path) -> None:
    for export in exports:
        for how, source in (("acting", export.path("openscenario", ".xosc")), ("recorded", export.recorded())):
            scenario = tmp_path / f"{export.suite}-{export.id}-{how}.json"
            imported = json.loads(run(recrash, "import", source, "--out", scenario, "--simulate", "--json"))
            assert imported["run"]["rollout"]["state_hash"] == export.rollout["state_hash"], f"{export} {how}"
            edits = [d for d in imported["imported"]["diagnostics"] if d["code"].startswith("openscenario")]
            assert edits == [], f"{export} {how}"
            simulated = json.loads(run(recrash, "simulate", scenario, "--json"))
            assert simulated["rollout"]["state_hash"] == export.rollout["state_hash"], f"{export} {how}"
