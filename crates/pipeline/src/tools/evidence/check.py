"""Checks a folder of evidence that recrash wrote (python3 check.py [FOLDER]). Python 3.8 or later, nothing else.

manifest.json names every file by its SHA-256; numbers.json holds every number with its formula. Each number is worked
out again here, from the rollouts or by counting, and every claim must say the numbers as they stand there.
"""
import hashlib, json, math, struct, sys
from pathlib import Path

STEP_S, TOUCH_S, TOUCH_M, SLACK_M, FRICTION, APPROACH_M, Z95 = 0.1, 0.025, 0.02, 0.01, 0.5, 0.1, 1.959963984540054

class Box:
    """A rectangle: middle, half sizes, and its axis."""

    def __init__(self, state, length, width, moved=(0.0, 0.0)):
        self.x, self.y = state["x"] + moved[0], state["y"] + moved[1]
        self.half = (0.5 * length, 0.5 * width)
        self.axis = (math.cos(state["heading"]), math.sin(state["heading"]))
        self.left = (-self.axis[1], self.axis[0])

    def corners(self):
        for along, across in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
            yield self.world(along * self.half[0], across * self.half[1])

    def world(self, along, across):
        return (self.x + along * self.axis[0] + across * self.left[0], self.y + along * self.axis[1] + across * self.left[1])

    def nearest(self, point):
        offset = (point[0] - self.x, point[1] - self.y)
        along, across = dot(offset, self.axis), dot(offset, self.left)
        clamp = lambda value, half: max(-half, min(half, value))
        return self.world(clamp(along, self.half[0]), clamp(across, self.half[1]))

    def reach(self, direction):
        return self.half[0] * abs(dot(self.axis, direction)) + self.half[1] * abs(dot(self.left, direction))

dot = lambda a, b: a[0] * b[0] + a[1] * b[1]
cross = lambda a, b: a[0] * b[1] - a[1] * b[0]

def nearest_points(a, b):
    """On a, on b, and how far apart; boxes that do not overlap are nearest at a corner."""
    pairs = [(a.nearest(corner), corner) for corner in b.corners()] + [(corner, b.nearest(corner)) for corner in a.corners()]
    return min(((p, q, math.dist(p, q)) for p, q in pairs), key=lambda found: found[2])

def gap(a, b):
    """Distance of two boxes; 0 where they overlap."""
    apart = (b.x - a.x, b.y - a.y)
    if all(abs(dot(apart, d)) <= a.reach(d) + b.reach(d) for d in (a.axis, a.left, b.axis, b.left)):
        return 0.0
    return nearest_points(a, b)[2]

def shared(a, b):
    """Corners of what two boxes share, by cutting one with the sides of the other."""
    corners = list(a.corners())
    for axis, half in ((b.axis, b.half[0]), (b.left, b.half[1])):
        for sign in (1.0, -1.0):
            normal = (sign * axis[0], sign * axis[1])
            limit, cut = dot(normal, (b.x, b.y)) + half, []
            for here, after in zip(corners, corners[1:] + corners[:1]):
                one, two = dot(normal, here) - limit, dot(normal, after) - limit
                if one <= 0.0:
                    cut.append(here)
                if one * two < 0.0:
                    share = one / (one - two)
                    cut.append((here[0] + share * (after[0] - here[0]), here[1] + share * (after[1] - here[1])))
            corners = cut
    return corners

def area_and_middle(corners):
    if not corners:
        return 0.0, None
    origin, double, sums = corners[0], 0.0, [0.0, 0.0]
    for p, q in zip(corners[1:], corners[2:]):
        a, b = (p[0] - origin[0], p[1] - origin[1]), (q[0] - origin[0], q[1] - origin[1])
        part = cross(a, b)
        double, sums = double + part, [sums[0] + (a[0] + b[0]) * part, sums[1] + (a[1] + b[1]) * part]
    if double > 1e-12:
        return 0.5 * double, (origin[0] + sums[0] / (3.0 * double), origin[1] + sums[1] / (3.0 * double))
    return 0.5 * double, (sum(p[0] for p in corners) / len(corners), sum(p[1] for p in corners) / len(corners))

def impulse(masses, boxes, speeds, tracks, states):
    """Of the collision on the second one: plane impact without restitution, friction along the plane (docs/models/severity.md)."""
    first, second = boxes
    relative = (speeds[0][0] - speeds[1][0], speeds[0][1] - speeds[1][1])
    apart = (second.x - first.x, second.y - first.y)
    ways = [(d if dot(apart, d) >= 0.0 else (-d[0], -d[1])) for d in (first.axis, first.left, second.axis, second.left)]
    depth = lambda d: first.reach(d) + second.reach(d) - dot(apart, d)
    before = lambda d: depth(d) - dot(relative, d) * TOUCH_S
    young = [d for d in ways if dot(relative, d) > 1e-6 and before(d) <= SLACK_M]
    normal = min(young, key=lambda d: depth(d) / dot(relative, d)) if young else min(ways, key=before)
    moved = second
    if area_and_middle(shared(first, second))[0] <= TOUCH_M**2:
        p, q, off = nearest_points(first, second)
        way = (p[0] - q[0], p[1] - q[1]) if off > 1e-9 else (-apart[0], -apart[1])
        way, by = (way[0] / math.hypot(*way), way[1] / math.hypot(*way)), max(off, 0.0) + TOUCH_M
        moved = Box(states[1], tracks[1]["length_m"], tracks[1]["width_m"], (way[0] * by, way[1] * by))
    point = area_and_middle(shared(first, moved))[1] or (first.x, first.y)
    along = (-normal[1], normal[0])
    nn = tt = nt = 0.0
    for mass, box in zip(masses, boxes):
        if mass is None:
            continue
        inertia = mass * (4.0 * box.half[0] ** 2 + 4.0 * box.half[1] ** 2) / 12.0
        arm = (point[0] - box.x, point[1] - box.y)
        n, t = cross(arm, normal), cross(arm, along)
        nn, tt, nt = nn + 1.0 / mass + n * n / inertia, tt + 1.0 / mass + t * t / inertia, nt + n * t / inertia
    wanted_n, wanted_t = dot(relative, normal), dot(relative, along)
    if wanted_n <= 0.0 or nn == 0.0:
        return (0.0, 0.0)
    determinant = nn * tt - nt * nt
    n, t = (wanted_n * tt - wanted_t * nt) / determinant, (wanted_t * nn - wanted_n * nt) / determinant
    if abs(t) > FRICTION * n:
        n = wanted_n / (nn + math.copysign(FRICTION, t) * nt)
        t = math.copysign(FRICTION * n, t)
    return (normal[0] * n + along[0] * t, normal[1] * n + along[1] * t)

class Run:
    """What a rollout shows, from its tracks and events alone."""

    def __init__(self, rollout, limits, masses, handover_s):
        actors, events = rollout["actors"], rollout["events"]
        ego, self.values = actors[0], {"duration": rollout["termination"]["time_s"]}
        touches = [e for e in events if e["kind"]["event"] == "contact" and e["kind"]["a"] == 0]
        touched = dict(touches[0]["kind"], time_s=touches[0]["time_s"]) if touches else None
        end = touched["time_s"] if touched else math.inf
        hash64 = 0xCBF29CE484222325
        for actor in actors:
            for state in actor["states"]:
                for byte in struct.pack("<7d", *(state[n] for n in ("x", "y", "heading", "vx", "vy", "steer", "throttle"))):
                    hash64 = ((hash64 ^ byte) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
        self.values["state_hash"] = f"{hash64:016x}"
        least, first = {}, {}
        still = lambda pose: [dict(pose["position"], heading=pose["heading"])] * len(ego["states"])
        things = [dict(thing, role="thing", states=still(thing["pose"])) for thing in rollout["obstacles"]]
        with_parts = lambda at: [(actors + things)[at]] + [part for part in actors if part.get("part_of") == at]
        boxes_at = lambda at, k: [Box(one["states"][k], one["length_m"], one["width_m"]) for one in with_parts(at) if k < len(one["states"])]
        for at, actor in enumerate(actors[1:] + things, 1):
            from_s, until_s = actor.get("appears_s", 0.0) - 1e-9, actor.get("gone_s", math.inf) - 1e-9
            for k in range(0 if actor["role"] == "part" else min(len(ego["states"]), len(actor["states"]))):
                if handover_s - 1e-9 <= k * STEP_S <= end + 1e-9:
                    there = boxes_at(at, k) if from_s <= k * STEP_S < until_s else []
                    d = min((gap(a, b) for a in boxes_at(0, k) for b in there), default=1e6)
                    least[at], first[at] = min(d, least.get(at, math.inf)), first.get(at, d)
        bumps = [e for e in events if e["kind"]["event"] == "obstacle_contact" and handover_s - 1e-9 <= e["time_s"] <= end + 1e-9]
        hit = [len(actors) + e["kind"]["obstacle"] for e in bumps if e["kind"]["actor"] == 0]
        least.update(dict.fromkeys(hit + ([touched["b"]] if touched else []), 0.0))
        for role in ("thing", "traffic", "partner"):
            of_role = [d for at, d in least.items() if (actors + things)[at]["role"] == role]
            self.values["least_gap"] = min(of_role) if of_role else self.values.get("least_gap")
        others = [at for at in least if at < len(actors) and actors[at]["role"] == "partner" and not (touched and at == touched["b"])]
        near = any(least[at] < limits["min_gap_m"] and first[at] - least[at] > APPROACH_M for at in others)
        self.values["verdict"] = "failed" if touched or near or hit or rollout["termination"]["kind"] in ("off_road", "stuck") else "passed"
        if touched:
            states, tracks = (touched["a_state"], touched["b_state"]), (ego, actors[touched["b"]])
            boxes = [Box(state, track["length_m"], track["width_m"]) for state, track in zip(states, tracks)]
            speeds = [(state["vx"], state["vy"]) for state in states]
            weights = [track.get("mass_kg") or masses[track["kind"]] for track in tracks]
            size = math.hypot(*impulse(weights, boxes, speeds, tracks, states))
            self.values["contact_time"] = touched["time_s"]
            self.values["ego_speed"], self.values["other_speed"] = (math.hypot(*speed) for speed in speeds)
            self.values["closing_speed"] = math.hypot(speeds[0][0] - speeds[1][0], speeds[0][1] - speeds[1][1])
            for name, mass in zip(("ego_delta_v", "other_delta_v"), weights):
                self.values[name] = size / mass if mass else 0.0

def holds(item, where):
    """Whether an item has these values; a name may be a path."""
    for path, wanted in where.items():
        value = item
        for name in path.split("/"):
            value = value.get(name) if isinstance(value, dict) else None
        if value != wanted:
            return False
    return True

def wilson(of, among, sign):
    if among == 0:
        return 0.0 if sign < 0 else 1.0
    share, extra = of / among, Z95 * Z95 / among
    middle, spread = share + extra / 2.0, Z95 * math.sqrt(share * (1.0 - share) / among + extra / (4.0 * among))
    return (middle + sign * spread) / (1.0 + extra)

def again(number, numbers, lists, runs):
    """A number, worked out again."""
    formula = number["formula"]
    if formula == "count":
        return sum(holds(item, number["where"]) for item in lists(number["list"]))
    if formula in ("share", "wilson_low", "wilson_high"):
        of, among = (numbers[number[name]]["value"] for name in ("of", "among"))
        return (of / among if among else 0.0) if formula == "share" else wilson(of, among, -1 if formula == "wilson_low" else 1)
    if formula == "max":
        return max((n["value"] for n in numbers.values() if n["formula"] in number["over"]), default=0.0)
    return runs(number["test"]).values.get(formula)

def same(a, b):
    numeric = all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in (a, b))
    return math.isclose(a, b, rel_tol=1e-9, abs_tol=1e-9) if numeric else a == b

def is_shown(number):
    shown, value = number["shown"].split(" ")[0], number["value"]
    if isinstance(value, str): return shown == value
    unit, digits = 100.0 if number["unit"] == "%" else 1.0, len(shown.partition(".")[2])
    return abs(float(shown) - unit * value) <= 0.501 * 10.0**-digits

def main(folder):
    wrong, read = [], lambda name: json.loads((folder / name).read_text(encoding="utf-8"))
    files = read("manifest.json")["files"]
    there = {p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file()} - {"manifest.json"}
    wrong += [f"{name}: it is not named in manifest.json" for name in sorted(there - set(files))]
    for name, sha256 in files.items():
        if name not in there or hashlib.sha256((folder / name).read_bytes()).hexdigest() != sha256:
            wrong.append(f"{name}: it is gone, or not as it was written")
    if wrong:
        return wrong, 0
    root = read("numbers.json")
    tests, limits = read("runs.json"), read("suite/frozen.json")["profile"]["failure"]
    by_id, numbers, cached = {t["id"]: t for t in tests["tests"]}, {n["id"]: n for n in root["numbers"]}, {}

    def runs(test):
        if test not in cached:
            ego = read(f"suite/scenarios/{test}.json")["ego"]
            cached[test] = Run(read(by_id[test]["rollout"]), limits, tests["masses_kg"], ego.get("handover_s", 0.0))
        return cached[test]

    lists = lambda place: read(place[0])[place[1]]
    wrong += [] if len(numbers) == len(root["numbers"]) else ["numbers.json: an id is there twice"]
    for number in root["numbers"]:
        try:
            value = again(number, numbers, lists, runs)
        except (KeyError, TypeError, ValueError, OSError) as error:
            value = f"an error: {error!r}"
        if not same(value, number["value"]):
            wrong.append(f"{number['id']}: {number['value']} is told, {value} comes out")
        if number["formula"] == "verdict" and by_id[number["test"]]["verdict"] != value:
            wrong.append(f"{number['id']}: runs.json has {by_id[number['test']]['verdict']}")
        wrong += [] if is_shown(number) else [f"{number['id']}: {number['shown']} is shown for {number['value']}"]
    claims = read("claims.json")["claims"]
    known = {claim["id"] for claim in claims}
    for claim in claims:
        text = claim["template"]
        for name in claim["numbers"]:
            text = text.replace("{" + name + "}", numbers[name]["shown"] if name in numbers else "?")
        if text != claim["text"] or "{" in text:
            wrong.append(f"claim {claim['id']}: it says something else than its numbers: {text}")
        missing = [other for other in claim["supported_by"] + claim["in_context_of"] if other not in known]
        wrong += [f"claim {claim['id']}: there is no {other}" for other in missing]
    return wrong, len(root["numbers"])

if __name__ == "__main__":
    problems, checked = main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent)
    print("\n".join(problems) or f"{checked} numbers come out as they are told, and every claim and file is as it was written")
    sys.exit(1 if problems else 0)
