"""Reports told again in other words, read beside what they retell: how often the accounts agree, field by field.

    python eval/reading/retold.py --recrash PROGRAM FILES...

FILES are NHTSA's crash files that hold the originals. Every row of eval/retold.csv takes the columns of the report that it retells, and its company stands in the column Reporting Entity.
"""

import argparse
import csv
import json
import subprocess
import tempfile
from collections import Counter
from pathlib import Path

RETOLD = Path(__file__).parents[1] / "retold.csv"
PLAIN = {
    "type": "crash_type", "role": "role", "striker": "striker", "came from": "came_from", "order": "order", "driver": "driver", "first contact": "first_contact",
}
SIDES = ("kind", "movement", "state", "standing", "heading", "lane")


def value(fact):
    return fact and json.dumps(fact["value"])


def acts(side: dict) -> list[str]:
    """What somebody did before the contact. That it drove along is left out: any verb may say so."""
    before = (act for act in side["acts"] if not act["after_contact"] and act["act"] != "follow")
    return [f"{act['act']} {act['side'] or ''}" for act in before]


def fields(account: dict) -> dict:
    said = {name: value(account[key]) for name, key in PLAIN.items()}
    for who, side in (("SV", account["sv"]), ("CP", account["partner"])):
        for name in SIDES:
            said[f"{who} {name}"] = side and value(side[name])
        said[f"{who} zones"] = sorted(value(zone) for zone in side["zones"]) if side else None
        said[f"{who} acts"] = acts(side) if side else None
    said["others"] = sorted(str(value(other["kind"])) for other in account["others"])
    return said


def read(recrash: str, what: str, rows: list[dict]) -> list[dict]:
    """What the program says of these rows."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "rows.csv"
        with file.open("w", newline="") as stream:
            writer = csv.DictWriter(stream, list(dict.fromkeys(name for row in rows for name in row)))
            writer.writeheader()
            writer.writerows(rows)
        done = subprocess.run([recrash, what, str(file), "--json"], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)["accounts" if what == "read" else "reconstructions"]


def rows_of(files: list[str]) -> dict[str, dict]:
    found = {}
    for file in files:
        with open(file, encoding="utf-8-sig", errors="replace", newline="") as stream:
            found |= {f"{row['Report ID']}/{row['Report Version']}": row for row in csv.DictReader(stream)}
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+")
    parser.add_argument("--recrash", required=True)
    arguments = parser.parse_args()
    found = rows_of(arguments.files)
    with RETOLD.open(newline="") as stream:
        retold = [row for row in csv.DictReader(stream) if row["report"] in found]
    for name in sorted({row["set"] for row in retold}):
        of = [row for row in retold if row["set"] == name]
        originals = [found[row["report"]] for row in of]
        again = [row | {"Narrative": new["narrative"], "Reporting Entity": new["company"] or row["Reporting Entity"]} for row, new in zip(originals, of)]
        agree(arguments.recrash, name, originals, again)


def agree(recrash: str, name: str, originals: list[dict], again: list[dict]) -> None:
    """Rows of the two files may have other columns: the older ones and the newer ones are read apart."""
    both, told = [], [0, 0]
    layouts = {tuple(row) for row in originals}
    for layout in sorted(layouts):
        pair = [[row for row in rows if set(row) == set(layout)] for rows in (originals, again)]
        accounts = [{account["report"]: fields(account) for account in read(recrash, "read", rows)} for rows in pair]
        both += [(accounts[0][report], accounts[1][report]) for report in sorted(accounts[0].keys() & accounts[1].keys())]
        for at, rows in enumerate(pair):
            told[at] += sum(each["told"] for each in read(recrash, "reconstruct", rows))
    same = Counter(field for old, new in both for field in old if old[field] == new[field])
    print(f"set {name}: {len(both)} of {len(originals)} read both ways; {told[0]} told as reported, {told[1]} as retold")
    for field in both[0][0]:
        print(f"  {field:14} {same[field]:4} of {len(both)}  {100 * same[field] / len(both):5.1f} %")


if __name__ == "__main__":
    main()
