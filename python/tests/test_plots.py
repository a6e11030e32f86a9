"""Plots, notebook views and progress."""

from __future__ import annotations

import sys
import xml.etree.ElementTree as ElementTree

import pytest
from conftest import case

import recrash
from recrash import Scenario, _show

plots = pytest.importorskip("recrash.plots", reason="matplotlib is not installed")
from matplotlib import pyplot  # noqa: E402

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(autouse=True)
def closed():
    yield
    pyplot.close("all")


@pytest.fixture(scope="module")
def run():
    return Scenario.load(case("crashes/32-lead-reverses")).run("recorded")


def test_tracks_have_a_box_of_everybody_over_time_and_the_contact(run):
    ax = plots.tracks(run, every_s=1.0)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x [m]", "y [m]")
    colours = [patch.get_facecolor()[:3] for patch in ax.patches]
    expected = [*range(0, len(run.times), 10), len(run.times) - 1]
    for actor in run.actors:
        own = plots.matplotlib.colors.to_rgb(plots.COLOURS[actor["role"]])
        assert colours.count(own) == len(set(expected))
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert labels == ["ego", "partner", f"contact at {run.events[0]['time_s']:.1f} s"]
    # The ego's first box is where it stands.
    (x, y), length = run.states[0, 0, :2], run.actors[0]["length_m"]
    own = plots.matplotlib.colors.to_rgb(plots.COLOURS["ego"])
    corners = next(patch for patch in ax.patches if patch.get_facecolor()[:3] == own).get_xy()[:4]
    assert corners.mean(axis=0) == pytest.approx((x, y))
    assert corners[:, 0].max() - corners[:, 0].min() == pytest.approx(length, abs=0.05)


def test_series_are_in_si_units_and_those_of_the_run(run):
    speed, gap, ttc = plots.series(run)
    assert [ax.get_ylabel().replace("\n", " ") for ax in (speed, gap, ttc)] == [
        "speed [m/s]",
        "gap of boxes [m]",
        "time to collision [s]",
    ]
    assert ttc.get_xlabel() == "time [s]"
    assert list(gap.lines[0].get_ydata()) == run.series["partners"][0]["gap_m"]
    assert min(run.series["partners"][0]["gap_m"]) == pytest.approx(run.min_gap_m, abs=0.5)


def test_a_run_is_written_as_a_file_for_a_paper(run, tmp_path):
    for kind in ("pdf", "png", "svg"):
        plots.run(run).savefig(tmp_path / f"run.{kind}")
        assert (tmp_path / f"run.{kind}").stat().st_size > 5000


def test_a_corpus_and_results_have_a_bar_for_each_type():
    scenarios, made = recrash.read(where="road = intersection").reconstruct()
    ax = plots.corpus(made)
    types = {str(kind or "not told").replace("_", " ") for kind in made.to_dict()["crash_type"]}
    assert {label.get_text() for label in ax.get_yticklabels()} == types
    assert sum(bar.get_width() for bar in ax.patches) == len(made)
    assert ax.get_xlabel() == "incidents"
    table = recrash.test(scenarios, "idm")
    bars, contacts = plots.results(table)
    assert sum(bar.get_width() for bar in bars.patches) == len(table)
    with_contact = [value for value in table.to_dict()["delta_v_mps"] if value is not None]
    assert sum(bar.get_height() for bar in contacts.patches) == len(with_contact)
    assert contacts.get_xlabel().endswith("[m/s]")


def test_results_of_an_ego_that_always_raises_are_drawn(crashes):
    def broken(_):
        raise RuntimeError("no")

    bars, _ = plots.results(recrash.test(crashes, broken), by="template")
    assert [text.get_text() for text in bars.get_legend().get_texts()] == ["not run"]


def test_a_run_and_a_scenario_show_a_replay_that_is_sound_xml(run):
    picture = ElementTree.fromstring(_show.replay(run))
    turns = picture.findall(f".//{SVG}animateTransform[@type='rotate']")
    assert len(turns) == len(run.actors)
    assert all(len(turn.get("values").split(";")) == len(run.times) for turn in turns)
    assert "script" not in _show.replay(run)
    assert run.termination in run._repr_html_()
    ElementTree.fromstring(run._repr_svg_())
    assert "lead-reverses" in Scenario.load(case("crashes/32-lead-reverses"))._repr_html_()


def test_whoever_leaves_is_hidden_in_the_replay():
    run = Scenario.load(case("acts/13-leave")).run("recorded")
    hidden = ElementTree.fromstring(_show.replay(run)).findall(f".//{SVG}animate[@attributeName='visibility']")
    assert [each.get("values") for each in hidden] == ["visible;hidden"]


def test_texts_of_strangers_are_escaped():
    draft = Scenario.load(case("crashes/32-lead-reverses")).to_dict()
    draft["source"]["records"] = []
    table = recrash.Table.of_rows([{"<script>": "<b>bold</b>"}])
    assert "<script>" not in _show.table_html(table)
    assert "&lt;b&gt;" in _show.table_html(table)


@pytest.mark.parametrize("with_tqdm", [True, False])
def test_progress_counts_and_a_stop_in_the_middle_leaves_a_clean_line(with_tqdm, monkeypatch, capsys):
    if with_tqdm:
        pytest.importorskip("tqdm", reason="tqdm is not installed")
    else:
        monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    assert list(_show.counted(range(3), "units", 3, True)) == [0, 1, 2]
    assert "3/3" in capsys.readouterr().err

    def stopped():
        for number in _show.counted(range(3), "units", 3, True):
            if number == 1:
                raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stopped()
    assert capsys.readouterr().err.endswith("\n")


def test_progress_is_shown_by_itself_only_where_somebody_looks(crashes, capsys):
    recrash.test(crashes, lambda _: (0.0, 0.0))
    assert capsys.readouterr().err == ""
    recrash.test(crashes, lambda _: (0.0, 0.0), progress=True)
    assert "36/36" in capsys.readouterr().err
