"""Draws exported maps as docs/formats/maps has them: OpenDRIVE as Scenic reads it, CommonRoad as commonroad-io does.

Runs in the environment of requirements/scenic.txt for .xodr, of requirements/commonroad.txt for .cr.xml:
draw_map.py FOLDER FILE...
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot


def opendrive(path: Path) -> None:
    from scenic.domains.driving.roads import Network

    pyplot.figure(figsize=(6, 4))
    Network.fromFile(path, useCache=False).show()
    pyplot.gca().set_aspect("equal")


def commonroad(path: Path) -> None:
    from commonroad.common.file_reader import CommonRoadFileReader
    from commonroad.visualization.mp_renderer import MPRenderer

    scenario, problems = CommonRoadFileReader(path).open()
    renderer = MPRenderer(figsize=(6, 4))
    scenario.draw(renderer)
    problems.draw(renderer)
    renderer.render()
    renderer.ax.set_aspect("equal")


if __name__ == "__main__":
    for path in map(Path, sys.argv[2:]):
        (opendrive if path.suffix == ".xodr" else commonroad)(path)
        pyplot.savefig(Path(sys.argv[1]) / f"{path.name.removesuffix('.xml')}.png", dpi=80, bbox_inches="tight")
        pyplot.close("all")
