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
import subprocess
from pathlib import Path

HERE = Path(__file__).parent
# In the files since June 2025 these contact areas are ticked under each other's names (crates/records/src/areas.rs).
MEANT = {
    "Front": "Front Left", "Front Left": "Front Right", "Front Right": "Front",
    "Rear": "Rear Left", "Rear Left": "Rear Right", "Rear Right": "Rear",
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


def areas(row: dict[str, str], side: str) -> list[str]:
    """The contact areas that are ticked of a side, as they are meant."""
    since_june_2025 = "Engagement Status" in row
    names = [column for column in row if column and column.startswith(f"{side} Contact Area")]
    ticked = [name.split("- ")[-1] for name in names if row[name] == "Y"]
    return [MEANT.get(area, area) if since_june_2025 else area for area in ticked]


def shown(recrash: str, scene: Path) -> str:
    """What the rollout with the recorded driver shows, in words (crates/lab/src/replay): as a language model gets it that reviews."""
    done = subprocess.run([recrash, "simulate", str(scene), "--ego", "recorded", "--words"], capture_output=True, text=True, check=True)
    return done.stdout.strip()


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
    for part in range(args.parts):
        chosen = drawn[part :: args.parts]
        with open(args.out / f"{part + 1}.md", "w") as stream:
            for _, report, scene in chosen:
                row = by_report[report]
                told = "; ".join(f"{name}: {row.get(column, '')}" for name, column in COLUMNS.items())
                stream.write(
                    f"## {report} ({scene.stem})\n\n{row['Narrative']}\n\n{told}; SV zones: {', '.join(areas(row, 'SV'))}; "
                    f"CP zones: {', '.join(areas(row, 'CP'))}\n\n```\n{shown(args.recrash, scene)}\n```\n\n"
                )
        with open(args.out / f"{part + 1}.csv", "w", newline="") as stream:
            stream.write("reading,report,incident,who,side,movements,order,standstill,striker,zones,right,note\n")


if __name__ == "__main__":
    main()
