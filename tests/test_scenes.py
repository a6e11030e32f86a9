"""Scenes with plans as OpenSCENARIO with OpenDRIVE, read by ASAM's checkers."""

from exports import Export
from oracles import answers


def test_asam_checkers_find_nothing(scenes: list[Export]) -> None:
    files = [str(scene.path("openscenario", suffix)) for scene in scenes for suffix in (".xosc", ".xodr")]
    for report in answers("qc", "qc.py", *files):
        assert report["issues"] == [], report["file"]
        assert "error" not in report["status"], report["file"]
