"""Oracle for box gap, shared area and time to collision, by shapely (GEOS).

Writes boxes.csv beside this file: pairs of moving boxes and what shapely says about them. The test in
`crates/metrics/src/oracle.rs` compares. Run again (same bytes) with shapely 2.x and numpy:

    python crates/metrics/oracle/boxes.py

Time to collision is found by brute force: the second box is moved in steps of 1 ms for 10 s, and the first step that
touches is refined by bisection. Pairs that only graze (no closer than 1 mm for certain) are drawn again.
"""

import csv
import pathlib

import numpy as np
import shapely
from shapely import affinity

PAIRS = 400
HORIZON_S = 10.0
STEP_S = 1e-3


def outline(length, width, x, y, heading):
    box = shapely.box(-length / 2, -width / 2, length / 2, width / 2)
    box = affinity.rotate(box, heading, origin=(0, 0), use_radians=True)
    return affinity.translate(box, x, y)


def time_to_collision(a, b, velocity):
    """First time at which `b`, moved at `velocity` relative to `a`, touches it; None if never; False if it grazes."""
    if a.distance(b) == 0.0:
        return 0.0
    times = np.arange(0.0, HORIZON_S + STEP_S, STEP_S)
    ring = shapely.get_coordinates(b)
    moved = shapely.polygons(ring[None, :, :] + times[:, None, None] * np.asarray(velocity)[None, None, :])
    distances = shapely.distance(a, moved)
    touching = np.flatnonzero(distances == 0.0)
    if touching.size == 0:
        return None if distances.min() > 1e-3 * (1 + np.hypot(*velocity)) else False
    if touching.size < 3:
        return False
    late = times[touching[0]]
    early = late - STEP_S
    for _ in range(60):
        middle = 0.5 * (early + late)
        if a.distance(affinity.translate(b, velocity[0] * middle, velocity[1] * middle)) == 0.0:
            late = middle
        else:
            early = middle
    return late


def main():
    rng = np.random.default_rng(20240607)
    sizes = [(4.515, 1.852), (5.74, 2.3), (12.0, 2.55), (1.8, 0.6), (0.5, 0.5), (0.4, 0.4)]
    rows = []
    while len(rows) < PAIRS:
        numbers = []
        for side in range(2):
            length, width = sizes[rng.integers(len(sizes))]
            spread = 0.0 if side == 0 else rng.choice([3.0, 12.0, 50.0])
            x, y = rng.normal(0.0, 1.0, 2) * spread + (100.0, -40.0)
            heading = rng.choice([rng.uniform(-np.pi, np.pi), rng.choice([0.0, 0.5, 1.0, -0.5]) * np.pi])
            speed = rng.choice([0.0, rng.uniform(0.5, 22.0)])
            numbers.append([round(float(v), 6) for v in (length, width, x, y, heading, speed)])
        if len(rows) % 2:  # On a collision course, or nearly.
            (ca, va), (_, vb) = ((np.array(n[2:4]), np.array([np.cos(n[4]), np.sin(n[4])]) * n[5]) for n in numbers)
            place = ca + (va - vb) * rng.uniform(0.1, 9.0) + rng.normal(0.0, 1.5, 2)
            numbers[1][2:4] = [round(float(v), 6) for v in place]
        a, b = (outline(*n[:5]) for n in numbers)
        va, vb = (np.array([np.cos(n[4]), np.sin(n[4])]) * n[5] for n in numbers)
        ttc = time_to_collision(a, b, vb - va)
        if ttc is False:
            continue
        shared = a.intersection(b)
        centroid = [shared.centroid.x, shared.centroid.y] if shared.area > 0.0 else ["", ""]
        row = numbers[0] + numbers[1] + [a.distance(b), shared.area, *centroid, "" if ttc is None else ttc]
        rows.append([v if isinstance(v, str) else repr(float(v)) for v in row])
    columns = [f"{name}_{side}" for side in "ab" for name in ("length", "width", "x", "y", "heading", "speed")]
    columns += ["gap", "shared_area", "shared_x", "shared_y", "ttc"]
    with open(pathlib.Path(__file__).with_name("boxes.csv"), "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(rows)
    met = [row for row in rows if row[-1] not in ("", "0.0")]
    print(f"{len(rows)} pairs, {sum(row[12] == '0.0' for row in rows)} overlapping, {len(met)} on a collision course")


if __name__ == "__main__":
    main()
