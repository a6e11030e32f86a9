"""Packets for a blind reading of reconstructions: the report, and what its rollout shows. Nothing of the account.

    recrash reconstruct FILES... --to-dir scenes
    python eval/reading/packets.py --recrash PROGRAM --scenes scenes --half dev --count 60 --word spring --out packets FILES...

Incidents are drawn by SHA-256 of WORD and the report id, from the scenarios of `scenes`; reports that eval/reconstructions.csv
has are left out, but with --again. Of several reports of an incident the one is printed that its account is read from. A reader gets packets/N.md, by eval/reading/GUIDE.md, and fills packets/N.csv.
"""

import argparse
import csv
import hashlib
import json
import math
import subprocess
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
# In the files since June 2025 these contact areas are ticked under each other's names (crates/records/src/areas.rs).
MEANT = {
    "Front": "Front Left", "Front Left": "Front Right", "Front Right": "Front",
    "Rear": "Rear Left", "Rear Left": "Rear Right", "Rear Right": "Rear",
}
# As in crates/model/src/scenario/graph.rs.
USUAL_WIDTH_M = {
    "driving": 3.3, "centre_turn": 3.3, "bike": 1.8, "parking": 2.4, "stalls": 5.5, "shoulder": 2.5, "median": 1.5, "sidewalk": 2.5,
}
COLUMNS = {
    "SV movement": "SV Pre-Crash Movement",
    "CP movement": "CP Pre-Crash Movement",
    "crash with": "Crash With",
    "SV speed (mph)": "SV Precrash Speed (MPH)",
    "roadway": "Roadway Type",
    "posted (mph)": "Posted Speed Limit (MPH)",
}


def digest(*parts: str) -> bytes:
    return hashlib.sha256("".join(parts).encode()).digest()


def rows(files: list[str]) -> dict[str, dict[str, str]]:
    """Rows by 'report id/version'; of several the last."""
    found = {}
    for file in files:
        with open(file, encoding="utf-8-sig", errors="replace", newline="") as stream:
            for row in csv.DictReader(stream):
                found[f"{row['Report ID']}/{row['Report Version']}"] = row
    return found


def leading(recrash: str, files: list[str]) -> dict[str, str]:
    """By the name of its scenario, the report that speaks for an incident: not the first version, where a later one tells more."""
    read = subprocess.run([recrash, "read", *files, "--json"], capture_output=True, text=True, check=True)
    return {f"incident-{account['incident'].replace('#', '')}": account["report"] for account in json.loads(read.stdout)["accounts"]}


def degrees(angle: float) -> int:
    return round(math.degrees(math.remainder(angle, math.tau)))


def areas(row: dict[str, str], side: str) -> list[str]:
    """The contact areas that are ticked of a side, as they are meant."""
    since_june_2025 = "Engagement Status" in row
    names = [column for column in row if column and column.startswith(f"{side} Contact Area")]
    ticked = [name.split("- ")[-1] for name in names if row[name] == "Y"]
    return [MEANT.get(area, area) if since_june_2025 else area for area in ticked]


def way(state: dict) -> str:
    speed = math.hypot(state["vx"], state["vy"])
    along = state["vx"] * math.cos(state["heading"]) + state["vy"] * math.sin(state["heading"])
    return f"{speed:.1f} m/s{' in reverse' if along < -0.1 else ''}"


def seen_from(ego: dict, other: dict) -> str:
    """Where the centre of another is, in the frame of the ego as it stands then, and where it points."""
    dx, dy = other["x"] - ego["x"], other["y"] - ego["y"]
    c, s = math.cos(ego["heading"]), math.sin(ego["heading"])
    ahead, left = dx * c + dy * s, dy * c - dx * s
    return (
        f"{abs(ahead):.1f} m {'ahead' if ahead >= 0 else 'behind'}, {abs(left):.1f} m {'left' if left >= 0 else 'right'}, "
        f"points {degrees(other['heading'] - ego['heading']):+d} deg to the ego's heading, {way(other)}"
    )


def strip_widths(strips: list[dict]) -> list[tuple[str, float, float]]:
    """Kind of each strip of one side of a road, and from where to where it lies beside the road's line."""
    found, at = [], 0.0
    for strip in strips:
        width = strip.get("width_m") or USUAL_WIDTH_M[strip["kind"]]
        found.append((strip["kind"], at, at + width))
        at += width
    return found


def beside(road: dict, junctions: dict[str, dict], state: dict) -> tuple[float, float, float] | None:
    """Of a straight road: how far to the left of its line a centre is, the angle to the line, and the sign of its own direction along it;
    nothing where the centre is not beside the line."""
    start = road["start"].get("at")
    if start is None:
        arm = road["start"]["arm"]
        junction, angle = junctions[arm["junction"]], math.radians(arm["bearing_deg"])
        x, y = (junction[axis] + arm["from_m"] * turn(angle) for axis, turn in (("x_m", math.cos), ("y_m", math.sin)))
    else:
        x, y, angle = start["x_m"], start["y_m"], math.radians(start["heading_deg"])
    dx, dy = state["x"] - x, state["y"] - y
    along, left = dx * math.cos(angle) + dy * math.sin(angle), dy * math.cos(angle) - dx * math.sin(angle)
    if not 0 <= along <= sum(piece["straight"]["length_m"] for piece in road["line"]):
        return None
    turned = math.remainder(state["heading"] - angle, math.tau)
    return left, abs(math.sin(turned)), 1.0 if math.cos(turned) > 0 else -1.0


def on_strip(road: dict, junctions: dict[str, dict], actor: dict, state: dict) -> str | None:
    """On which strip of a straight road a centre is, as the ego's driver would say it, and how far the body reaches over the edges of that;
    nothing where it is beside the road."""
    found = beside(road, junctions, state)
    if found is None:
        return None
    left, slant, gear = found
    side = "left" if left > 0 else "right"
    strips = strip_widths(road.get(side, []))
    kind = next((kind for kind, near, far in strips if near <= abs(left) <= far), None)
    if kind is None:
        return None
    # Roads but the first kind lead away from the junction: those who come to it drive on their left.
    leads = (side == "right") == ("at" in road["start"])
    ways = ("along the ego's way", "against the ego's way")
    way = {"main": ways, "own": ways, "ahead": ways[::-1]}
    to, fro = way.get(road["id"], ("to the junction", "away from it"))
    lanes = [(near, far) for name, near, far in strips if name == "driving"]
    number = next((n for n, (near, far) in enumerate(lanes, 1) if near <= abs(left) <= far), None)
    what = f"lane {number} of {len(lanes)} from the middle" if number and kind == "driving" else f"the {kind} strip"
    over = "".join(f", {reach}" for reach in reaches(road, actor, left, slant, gear))
    return f"{what} {to if leads else fro} of road '{road['id']}'{over}"


# Whose body is at more than this to the road lies across it; less than this over an edge nobody sees. [sine, m]
ACROSS, LEAST_OVER_M = 0.5, 0.1


def reaches(road: dict, actor: dict, left: float, slant: float, gear: float) -> list[str]:
    """Over which edges of the strip that its centre is on a body reaches, by how much, and into what, by its own left and right."""
    if slant > ACROSS:
        return []
    half = 0.5 * (actor["width_m"] * math.sqrt(1 - slant**2) + actor["length_m"] * slant)
    # Every strip from the left of the line to the right of it.
    strips = [(kind, near, far) for kind, near, far in strip_widths(road.get("left", []))]
    strips += [(kind, -far, -near) for kind, near, far in strip_widths(road.get("right", []))]
    own = next(((near, far) for _, near, far in strips if near <= left <= far), None)
    found = []
    for kind, near, far in strips:
        by = min(far, left + half) - max(near, left - half)
        if own is None or (near, far) == own or by < LEAST_OVER_M:
            continue
        to_left = (near >= own[1]) == (gear > 0)
        # The next lane is another one of the same direction, or one of the other.
        name = f"the {kind} strip" if kind != "driving" else "the next lane" if (near < 0) == (own[0] < 0) else "a lane of the other direction"
        found.append(f"{by:.1f} m over its {'left' if to_left else 'right'} edge into {name}")
    return found


def stands_on(draft: dict, actor: dict, state: dict) -> str:
    junctions = {junction["id"]: junction for junction in draft["map"].get("junctions", [])}
    found = (on_strip(road, junctions, actor, state) for road in draft["map"]["roads"])
    return next((strip for strip in found if strip), "in the junction or beside the roads")


def touched(event: dict, actors: list[dict], obstacles: list[dict]) -> str:
    kind = event["kind"]
    if kind["event"] == "contact":
        a, b = actors[kind["a"]], actors[kind["b"]]
        return f"{event['time_s']:.2f} s: {a['id']} and {b['id']} touch"
    if kind["event"] == "obstacle_contact":
        return f"{event['time_s']:.2f} s: {actors[kind['actor']]['id']} touches thing {kind['obstacle']}"
    return f"{event['time_s']:.2f} s: {kind['event']}"


def swings(states: list[dict[str, float]], until: int) -> str:
    """How far an arm has turned from where it was at first: when it begins to, and at the contact."""
    turned = [degrees(state["heading"] - states[0]["heading"]) for state in states[: until + 1]]
    begins = next((step for step, by in enumerate(turned) if abs(by) > 1), None)
    return "does not turn" if begins is None else f"begins to turn at {begins / 10:.1f} s, turned by {turned[-1]:+d} deg at the contact"


def shown(recrash: str, scene: Path, folder: Path) -> str:
    """What the rollout with the recorded driver shows, second by second."""
    target = folder / "rollout.json"
    done = subprocess.run(
        [recrash, "simulate", str(scene), "--ego", "recorded", "--rollout", str(target)],
        capture_output=True, text=True, check=False,
    )
    rollout, draft = json.loads(target.read_text()), json.loads(scene.read_text())
    target.unlink()
    actors = rollout["actors"]
    ego = actors[0]["states"]
    contact = next((e["time_s"] for e in rollout["events"] if "contact" in e["kind"]["event"]), len(ego) / 10)
    lines = [f"Roads: {json.dumps(draft['map'])}", f"Signals and signs: {json.dumps(draft.get('control', []))}"]
    if draft.get("objects"):
        lines.append(f"Things: {json.dumps(draft['objects'])}")
    lines += ["Road users: " + "; ".join(
        f"{a['id']} is a {a['kind']} ({a['length_m']} x {a['width_m']} m)"
        + (f", a part of {actors[a['part_of']]['id']}" if a.get("part_of") is not None else "")
        for a in actors)]
    for name, step in (("start", 0), ("contact", min(int(contact * 10), len(ego) - 1))):
        there = [a for a in actors if a["role"] != "part" and a.get("appears_s", 0) <= step / 10 < a.get("gone_s", math.inf)]
        lines.append(f"Centres at the {name}: " + "; ".join(f"{a['id']}: {stands_on(draft, a, a['states'][step])}" for a in there))
    for part in (a for a in actors if a["role"] == "part" and a["length_m"] < 1.5):
        owner, step = actors[part["part_of"]], min(int(contact * 10), len(ego) - 1)
        opened = degrees(part["states"][step]["heading"] - owner["states"][step]["heading"])
        shut = degrees(part["states"][0]["heading"] - owner["states"][0]["heading"])
        lines.append(f"Door of {owner['id']}: turned by {abs(degrees(math.radians(opened - shut)))} deg from shut at the contact")
    for arm in (a for a in actors if a["role"] == "part" and a["kind"] == actors[a["part_of"]]["kind"] and a["length_m"] >= 1.5):
        if arm["kind"] == "fixed_object":
            lines.append(f"Arm of {actors[arm['part_of']]['id']}: {swings(arm['states'], min(int(contact * 10), len(ego) - 1))}")
    start = ego[0]
    steps = list(range(0, min(len(ego), int(contact * 10) + 11), 5))
    for step in steps:
        state = ego[step]
        c, s = math.cos(start["heading"]), math.sin(start["heading"])
        dx, dy = state["x"] - start["x"], state["y"] - start["y"]
        line = (
            f"{step / 10:4.1f} s | ego {dx * c + dy * s:.1f} m along, {dy * c - dx * s:+.1f} m to the left of where it began, "
            f"turned {degrees(state['heading'] - start['heading']):+d} deg, {way(state)}"
        )
        for other in actors[1:]:
            if other["role"] == "part" and other["kind"] == actors[other.get("part_of") or 0]["kind"]:
                continue
            gone = other.get("gone_s")
            if step / 10 < other.get("appears_s", 0) or (gone is not None and step / 10 >= gone):
                continue
            line += f" | {other['id']} {seen_from(state, other['states'][min(step, len(other['states']) - 1)])}"
        lines.append(line)
    lines += ["Events: " + "; ".join(touched(e, actors, rollout["obstacles"]) for e in rollout["events"])]
    said = [line.strip() for line in done.stdout.splitlines() if line.startswith("contact at")]
    return "\n".join(lines + said)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+")
    parser.add_argument("--recrash", default="recrash")
    parser.add_argument("--scenes", type=Path, required=True)
    parser.add_argument("--half", choices=["dev", "held-out"], required=True)
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--parts", type=int, default=2, help="packets, one a reader")
    parser.add_argument("--word", required=True)
    parser.add_argument("--skip", type=Path, action="append", default=[], help="further files with a column `report`")
    parser.add_argument("--again", action="store_true", help="draw from all of the half, also what was read before")
    parser.add_argument("--out", type=Path, required=True)
    args = parser.parse_args()
    read_before = set()
    for file in [*([] if args.again else [HERE.parent / "reconstructions.csv"]), *args.skip]:
        with open(file, newline="") as stream:
            read_before |= {row["report"].split("/")[0] for row in csv.DictReader(stream)}
    speaks, drawn = leading(args.recrash, args.files), []
    for scene in sorted(args.scenes.glob("incident-*.json")):
        report = speaks[scene.stem]
        half = "dev" if digest(report.split("/")[0])[31] % 2 == 0 else "held-out"
        if half == args.half and report.split("/")[0] not in read_before:
            drawn.append((digest(args.word, report), report, scene))
    drawn = sorted(drawn)[: args.count]
    by_report = rows(args.files)
    args.out.mkdir(parents=True)
    with tempfile.TemporaryDirectory() as folder:
        for part in range(args.parts):
            chosen = drawn[part :: args.parts]
            with open(args.out / f"{part + 1}.md", "w") as stream:
                for _, report, scene in chosen:
                    row = by_report[report]
                    told = "; ".join(f"{name}: {row.get(column, '')}" for name, column in COLUMNS.items())
                    stream.write(
                        f"## {report} ({scene.stem})\n\n{row['Narrative']}\n\n{told}; SV zones: {', '.join(areas(row, 'SV'))}; "
                        f"CP zones: {', '.join(areas(row, 'CP'))}\n\n```\n{shown(args.recrash, scene, Path(folder))}\n```\n\n"
                    )
            with open(args.out / f"{part + 1}.csv", "w", newline="") as stream:
                stream.write("reading,report,incident,who,side,movements,order,standstill,striker,zones,right,note\n")


if __name__ == "__main__":
    main()
