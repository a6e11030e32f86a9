"""The page of columns (`docs/tables.md`) names what the tables have, and nothing else."""

from __future__ import annotations

import re

import pytest
from conftest import CASES, case

import recrash
from recrash import Scenario

PAGE = CASES.parent / "docs" / "tables.md"


def named(section: str) -> set[str]:
    """The names in the first column of a section's table."""
    (body,) = re.findall(rf"^## {section}\n(.*?)(?=^## |\Z)", PAGE.read_text("utf-8"), re.DOTALL | re.MULTILINE)
    rows = re.findall(r"^\| (`[^|]*) \|", body, re.MULTILINE)
    names = [name for row in rows for name in re.findall(r"`([^`]*)`", row)]
    assert names and len(names) == len(set(names)), section
    return set(names)


def in_text(section: str, key: str) -> set[str]:
    """The names behind a key, in the other columns of its row."""
    (body,) = re.findall(rf"^## {section}\n(.*?)(?=^## |\Z)", PAGE.read_text("utf-8"), re.DOTALL | re.MULTILINE)
    (row,) = [line for line in body.splitlines() if line.startswith("| ") and f"`{key}`" in line.split("|")[1]]
    return set(re.findall(r"`([^`]*)`", row.split("|", 2)[2]))


@pytest.fixture(scope="module")
def accounts():
    return recrash.read()


@pytest.fixture(scope="module")
def crash():
    """A run that ends in a contact of two."""
    return Scenario.load(case("crashes/32-lead-reverses")).run("recorded")


def test_accounts_records_and_reconstructions(accounts):
    assert named("Accounts") == set(accounts.table.column_names)
    assert named("Records") == set(recrash.records().column_names)
    assert named("Reconstructions") == set(accounts.part(0, 3).reconstruct()[1].column_names)


def test_tests_and_tracks(crashes, crash):
    assert named("Tests") == set(recrash.test(crashes / "32-lead-reverses.json", "idm").column_names)
    assert named("Tracks") == set(crash.tracks.column_names)


def test_metrics_and_severity(crash):
    assert named("Metrics") == set(crash.metrics)
    assert crash.metrics["partners"][0].keys() <= in_text("Metrics", "partners")
    assert crash.metrics["contact"].keys() == in_text("Metrics", "contact")
    assert crash.metrics["ego"].keys() == in_text("Metrics", "ego")
    assert named("Severity") - {"obstacle"} == set(crash.severity)
    assert crash.severity["first"].keys() <= in_text("Severity", "first")


def test_one_account(accounts):
    keys = set().union(*(accounts[number].keys() for number in range(len(accounts))))
    assert keys | {"ahead", "author"} == named("One account")
    sides = in_text("One account", "sv")
    assert accounts[0]["sv"].keys() - {"astride", "turns_next"} == sides
