"""Checks CommonRoad files against the XSD in commonroad-io's own wheel, and reads them. Prints one JSON object per file.

Runs in the environment of requirements/commonroad.txt.
"""

import json
import sys
import warnings
from pathlib import Path

import commonroad
from commonroad.common.file_reader import CommonRoadFileReader
from lxml import etree

SCHEMA = Path(commonroad.__file__).parent / "common" / "xml_definition_files" / "XML_commonRoad_XSD.xsd"


def read(path, schema):
    document = etree.parse(path)
    valid = schema.validate(document)
    errors = [str(error) for error in schema.error_log][:5]
    scenario, problems = CommonRoadFileReader(path).open(lanelet_assignment=True)
    network = scenario.lanelet_network
    lanelets = {
        lanelet.lanelet_id: {
            "length": float(lanelet.distance[-1]),
            "successors": sorted(lanelet.successor),
            "predecessors": sorted(lanelet.predecessor),
            "left": lanelet.adj_left,
            "right": lanelet.adj_right,
        }
        for lanelet in network.lanelets
    }
    obstacles = []
    for obstacle in scenario.dynamic_obstacles:
        last = obstacle.prediction.trajectory.final_state
        states = [obstacle.initial_state] + list(obstacle.prediction.trajectory.state_list)
        obstacles.append(
            {
                "steps": int(last.time_step),
                "assigned": len(obstacle.initial_center_lanelet_ids or ()),
                "positions": [[float(state.position[0]), float(state.position[1])] for state in states],
            }
        )
    problem = next(iter(problems.planning_problem_dict.values()))
    start = problem.initial_state
    return {
        "file": path,
        "valid": valid,
        "errors": errors,
        "id": str(scenario.scenario_id),
        "dt": scenario.dt,
        "lanelets": lanelets,
        "intersections": [len(intersection.incomings) for intersection in network.intersections],
        "static_obstacles": len(scenario.static_obstacles),
        "dynamic_obstacles": obstacles,
        "start": [float(start.position[0]), float(start.position[1]), float(start.velocity)],
        "goals": len(problem.goal.state_list),
    }


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    compiled = etree.XMLSchema(etree.parse(str(SCHEMA)))
    for name in sys.argv[1:]:
        print(json.dumps(read(name, compiled)))
