"""highway-env's IDM driver in recrash's crashes: `pip install highway-env`, then `python highway_idm.py`.

Its own code decides, recrash moves. The same in a suite: `recrash run --ego py:highway_idm.py:HighwayIdm --out suite`. What
highway-env sees is the route as one lane of its own, and everybody else as a vehicle on or beside it.
"""

import math

import numpy as np
from highway_env.road.lane import PolyLaneFixedWidth
from highway_env.road.road import Road, RoadNetwork
from highway_env.vehicle.behavior import IDMVehicle
from highway_env.vehicle.kinematics import Vehicle

import recrash

#: Every so many points of the route (1 m apart) are enough for highway-env's spline.
THINNED = 5


class HighwayIdm:
    """An ego for `recrash.test`: highway-env's `IDMVehicle` on the route."""

    def reset(self, world):
        # y points to the right in highway-env.
        points = [(point["x"], -point["y"]) for point in world["route"]]
        thinned = points[:-1:THINNED] + points[-1:] if len(points) > 2 * THINNED else points
        network = RoadNetwork()
        network.add_lane("start", "end", PolyLaneFixedWidth([np.array(point) for point in thinned], width=3.5))
        self.road = Road(network=network, np_random=np.random.default_rng(0))
        self.dt_s, self.target_mps = world["dt_s"], world["target_speed_mps"]
        self.wheelbase_m = world["vehicle"]["wheelbase_m"]

    def control(self, observation):
        me = observation["ego"]
        self.road.vehicles = [self._other(other) for other in observation["actors"]]
        place = [me["x"], -me["y"]]
        driver = IDMVehicle(
            self.road, place, -me["heading"], me["speed"], ("start", "end", 0), self.target_mps, enable_lane_change=False
        )
        driver.LENGTH = self.wheelbase_m
        self.road.vehicles.append(driver)
        driver.act()
        return {
            "acceleration_mps2": float(driver.action["acceleration"]),
            "wheel_angle_rad": -float(driver.action["steering"]),
        }

    def _other(self, other):
        speed = math.hypot(other["vx"], other["vy"])
        return Vehicle(self.road, [other["x"], -other["y"]], -other["heading"], speed)


if __name__ == "__main__":
    scenarios, _ = recrash.read().reconstruct()
    for ego in (HighwayIdm, "idm", "reference"):
        rows = recrash.test(scenarios, ego).to_dicts()
        errors = [row["error"] for row in rows if row["error"]]
        failed, contacts = sum(bool(row["failed"]) for row in rows), sum(row["termination"] == "contact" for row in rows)
        print(f"{getattr(ego, '__name__', ego):>12}: {failed} of {len(rows)} failed, {contacts} contacts, {len(errors)} not run")
        print(*errors[:1], sep="\n", end="")
