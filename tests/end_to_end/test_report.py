"""The main job, run as a user would: the whole chain on a small study, then again."""

from __future__ import annotations

import html
import json
import re
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from contracts.curves import read_curve
from contracts.series import read_series
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from tests.end_to_end.small_study import both_pages, run, small_study_text
from workbench.charts.packing import unpacked
from workbench.questions.words.readings import READINGS
from workbench.study.magnitudes import GATES
from workbench.verdict.statements import statement_of

TASKS = {
    *("mesh", "mesh_whole", "fe_phi000", "ancf_wheel_phi000", "ancf_wheel_shape"),
    *(f"words_{reading.name}_phi{orientation:03.0f}" for reading in READINGS for orientation in (0, 45)),
    *(f"words_hoops{which}_phi{orientation:03d}" for which in ("", "_twin") for orientation in (0, 15, 30, 45, 60)),
    "rover_still",
    *("mesh_x1.5", "fe_x1.5_phi000", "mesh_x2", "fe_x2_phi000"),
    *(
        "section_phi000",
        "words_twin_phi000",
        "ancf_phi000",
        "ancf_phi045",
        "brush",
        "ancf_surfaces",
        "metrics",
        "parts_overlap",
        "footprint_phi000",
        "pictures",
    ),
    "environment_-40C",
    *("ancf_as_it_is", "ancf_fit_four_spokes", "ancf_fit_six_spokes"),
    *("ancf_plates_x1", "ancf_plates_x2", "ancf_plates_x4", "ancf_plates_x8"),
    *("ancf_drop", "ancf_drop_share", "ancf_ride"),
    *(f"rover_{name}" for name in SCENARIOS),
}

type Finished = subprocess.CompletedProcess[str]


def test_report_exits_0_and_says_what_it_did(first_report: Finished) -> None:
    assert first_report.returncode == 0, first_report.stdout + first_report.stderr
    assert first_report.stderr == ""
    assert set(re.findall(r"\] (\S+): computed", first_report.stdout)) == TASKS
    assert f"{len(TASKS)} tasks computed, 0 reused" in first_report.stdout


def test_summary_holds_the_agreed_fields(first_report: Finished, workspace: Path) -> None:
    summary = json.loads((workspace / "report" / "summary.json").read_text(encoding="utf-8"))
    assert (summary["schema"], summary["study"], summary["status"]) == (2, "exomars", "pass")
    ids = [c["id"] for c in summary["checks"]]
    assert len(ids) == len(set(ids))
    for wanted in ("words.band", "fe.energy", "fe.parts_overlap",
                   "fe.reach", "fe.mesh_uncertainty", "fe.yield",
                   "fe.spread_20mm", "mesh.mass", "ancf.preset_phi000",
                   "ancf.preset_phi045", "ancf.flexible_mass", "ancf.surfaces",
                   "ancf_vs_fe.relative_l2", "brush_vs_fe.relative_l2", "fe.first_yield_load",
                   "environment.similarity", "environment.stiffness_-40C"):  # fmt: skip
        assert wanted in ids
    assert not [i for i in ids if i.startswith(("fe.initial_tangent", "fe.deflection_at_"))]  # by them it was chosen
    gates = [c for c in summary["checks"] if c["role"] == "gate"]
    assert {c["status"] for c in gates} == {"pass"}
    assert {t["task"] for t in summary["timings"]} == TASKS
    assert all(t["wall_s"] >= 0.0 for t in summary["timings"])
    assert next(t["dofs"] for t in summary["timings"] if t["task"] == "fe_phi000") > 1000
    assert set(summary["provenance"]["tasks"]) == TASKS


def test_junit_holds_the_same_checks(first_report: Finished, workspace: Path) -> None:
    summary = json.loads((workspace / "report" / "summary.json").read_text(encoding="utf-8"))
    (suite,) = ElementTree.parse(workspace / "report" / "junit.xml").getroot()
    assert [case.get("name") for case in suite] == [c["id"] for c in summary["checks"]]
    assert suite.get("failures") == suite.get("errors") == "0"


def test_curves_are_csv_with_the_agreed_names_and_columns(first_report: Finished, workspace: Path) -> None:
    folder = workspace / "report" / "curves"
    names = {"ancf_wheel_phi000.csv", "ancf_wheel_average.csv",
             "fe_phi000.csv", "fe_average.csv", "ancf_phi000.csv", "ancf_phi045.csv", "ancf_average.csv",
             "brush_average.csv", "section_phi000.csv", "section_average.csv", "words_band_average.csv",
             "fe_-40C_phi000.csv", "fe_x1.5_phi000.csv", "fe_x2_phi000.csv"}  # fmt: skip
    names |= {f"ancf_{fit}_{place}.csv" for fit in ("four_spokes", "six_spokes") for place in ("phi000", "average")}
    assert {p.name for p in folder.iterdir()} == names
    for path in folder.iterdir():
        lines = path.read_text(encoding="utf-8").splitlines()
        assert next(line for line in lines if not line.startswith("#")).startswith("deflection_m,load_N")
        assert np.all(np.diff(read_curve(path).deflection) > 0.0)
    fields = {p.name for p in (workspace / "report" / "fields").iterdir()}
    assert fields == {"fe_phi000_20N.vtu", "fe_phi000_points.npz", "fe_phi000_pressure.npz", "parts.json"}
    fe = read_curve(folder / "fe_phi000.csv")
    assert fe.load[-1] > 10.0
    assert fe.deflection[-1] == pytest.approx(0.006)


def test_time_series_are_csv_and_linked(first_report: Finished, workspace: Path) -> None:
    """Named ``{scenario}_{tire}.csv``; the evidence holds each whole, and its section leads there."""
    folder = workspace / "report" / "series"
    wheel = {"wheel_drop_ancf.csv", "wheel_drop_share_ancf.csv", "wheel_half_round_ancf.csv"}
    assert {p.name for p in folder.iterdir()} == wheel | {f"{name}_brush.csv" for name in SCENARIOS}
    page = (workspace / "report" / "evidence.html").read_text(encoding="utf-8")
    section = page[page.index('<section id="ancf_dynamics">') :].partition("</section>")[0]
    for path in (folder / name for name in wheel):
        text = path.read_text(encoding="utf-8")
        assert text.startswith("# source: ANCF tire with ")
        header = next(line for line in text.splitlines() if not line.startswith("#"))
        assert header == "time_s,hub_x_m,hub_z_m,load_x_N,load_z_N"
        scenario = path.stem.removesuffix("_ancf")
        series = read_series(path, scenario, "ancf")
        assert np.all(np.diff(series.time) > 0.0)
        assert series.partial == (scenario == "wheel_drop_share"), "the tire folds under the rover's share"
        assert f'href="#series/{path.name}"' in section
        link = re.search(rf'href="data:application/gzip;base64,([^"]+)" download="{path.name}.gz"', page)
        assert link, path.name
        assert unpacked(link[1]).decode("utf-8") == text


def test_the_rover_has_its_section_and_its_series(first_report: Finished, workspace: Path) -> None:
    report, page = (
        (workspace / "report" / name).read_text(encoding="utf-8") for name in ("report.html", "evidence.html")
    )
    section = page[page.index('<section id="rover">') :].partition("</section>")[0]
    short = report[report.index('<section id="rover">') :].partition("</section>")[0]
    assert short.count("<tr>") == 1 + 7  # one row a scenario of the mission
    assert "static stability, 40 degrees" in short
    assert "not met" in short
    for name in SCENARIOS:
        path = workspace / "report" / "series" / f"{name}_brush.csv"
        assert not read_series(path, name, "brush").partial
        assert f'href="#series/{path.name}"' in section
        link = re.search(rf'href="data:application/gzip;base64,([^"]+)" download="{path.name}.gz"', page)
        assert link, name
        assert unpacked(link[1]).decode("utf-8") == path.read_text(encoding="utf-8")
    for text in ("Figs 18, 19", "Fig. 25", "not met", "197.92"):
        assert text in section


@pytest.mark.parametrize("name", ["report.html", "evidence.html"])
def test_a_page_is_self_contained(first_report: Finished, workspace: Path, name: str) -> None:
    """The other page is all that it names; it loads nothing."""
    page = (workspace / "report" / name).read_text(encoding="utf-8")
    outside_scripts = re.sub(r"<script.*?</script>", "", page, flags=re.DOTALL)
    assert not re.search(r"""(src|href)=["'](?!#|data:|(report|evidence)\.html[?#])""", outside_scripts)
    assert not re.search(r"<script[^>]+src=", page)


def test_the_pages_show_everything(first_report: Finished, workspace: Path) -> None:
    pages = both_pages(workspace / "report")
    assert re.sub(r"<script.*?</script>", "", pages, flags=re.DOTALL).count("data:image/webp;base64,") == 3
    summary = json.loads((workspace / "report" / "summary.json").read_text(encoding="utf-8"))
    gates = sum(c["role"] == "gate" for c in summary["checks"])
    for text in (f"All {gates} gates passed", "Inferred, not published", "inferred from the thesis", "FE average",
                 "ANCF 45", "brush line", "grid convergence index", "The deformed wheel on the ground",
                 "How to read this"):  # fmt: skip
        assert text in pages, text
    named = re.findall(r".{4}Sivo's data", html.unescape(pages))
    assert named
    assert set(named) == {"not Sivo's data"}


def test_every_link_of_both_pages_leads_somewhere(first_report: Finished, workspace: Path) -> None:
    """And both ways: each section that stands on both pages leads to its other part."""
    pages = {n: (workspace / "report" / f"{n}.html").read_text(encoding="utf-8") for n in ("report", "evidence")}
    places = {name: set(re.findall(r'\bid="([^"]+)"', page)) for name, page in pages.items()}
    for name, page in pages.items():
        for other, place in re.findall(r'href="(?:(report|evidence)\.html)?(?:\?[^"#]*)?#([^"]+)"', page):
            assert html.unescape(place) in places[other or name], (name, other, place)
    sections = {name: set(re.findall(r'<section id="([^"]+)"', page)) for name, page in pages.items()}
    both = sections["report"] & sections["evidence"]
    assert {"wheel", "fe", "strength", "rover"} <= both
    for section in both:
        assert f'href="evidence.html#{section}"' in pages["report"]
        assert f'href="report.html#{section}"' in pages["evidence"]


def test_every_number_of_the_first_page_has_its_source_one_click_away(first_report: Finished, workspace: Path) -> None:
    page, evidence = (
        (workspace / "report" / name).read_text(encoding="utf-8") for name in ("report.html", "evidence.html")
    )
    first = page[page.index('<section id="verdict">') :].partition("</section>")[0]
    checks = json.loads((workspace / "report" / "summary.json").read_text(encoding="utf-8"))["checks"]
    led = set(re.findall(r'href="evidence\.html#evidence-([^"]+)"', first))
    assert {check["id"] for check in checks if check["status"] != "pass"} <= led
    for name in led:
        fold = evidence[evidence.index(f'id="evidence-{name}"') :].partition("</details>")[0]
        assert "<dt>Source</dt>" in fold


def test_every_check_shows_its_evidence(first_report: Finished, workspace: Path) -> None:
    page = (workspace / "report" / "evidence.html").read_text(encoding="utf-8")
    checks = json.loads((workspace / "report" / "summary.json").read_text(encoding="utf-8"))["checks"]
    section = page[page.index('<section id="evidence">') : page.index('<section id="chosen">')]
    for check in checks:
        assert html.escape(check["claim"], quote=False).replace("'", "&#39;") in section, check["id"]
        assert check["tasks"], check["id"]
        assert all((workspace / "report" / name).is_file() for name in check["files"]), check["id"]
        assert all(f"{key[:12]}" in section for key in check["tasks"].values()), check["id"]
    assert any(check["files"] for check in checks)
    curve = workspace / "report" / "curves" / "fe_average.csv"
    link = re.search(r'id="curves/fe_average.csv" href="data:application/gzip;base64,([^"]+)"', section)
    assert link
    assert unpacked(link[1]) == curve.read_bytes()


def test_a_second_run_reuses_everything_and_a_wheel_that_fails_exits_1_if_asked(
    first_report: Finished, workspace: Path
) -> None:
    """Only the comparison changes: tolerances and a user's curve; the wheel misses its reach, which is a result."""
    (workspace / "mine.csv").write_text("# source: file\ndeflection_m,load_N\n0,0\n0.006,40\n", encoding="utf-8")
    mine = '[[reference.curves]]\nfile = "mine.csv"\nlabel = "my digitised curve"\nsource = "Someone, Fig. 1"\n'
    mine += 'kind = "published"\nuncertainty = "1 %"\n'
    strict = small_study_text().replace("[tolerances]", f"{mine}\n[tolerances]")
    strict = strict.replace('reach_deflection = "6 mm"', "").replace(
        "orientation_spread = 0.50", "orientation_spread = 5"
    )
    (workspace / "strict.toml").write_text(strict, encoding="utf-8")
    second = run("report", "strict.toml", "--out", "strict", "--store", "store", folder=workspace)
    assert second.returncode == 0, second.stderr
    assert "Does the wheel do its job? no: " in second.stdout
    assert f"1 tasks computed, {len(TASKS) - 1} reused" in second.stdout
    logs = sorted((workspace / "store" / "log").iterdir())
    third = run("report", "strict.toml", "--out", "strict", "--store", "store", "--require-wheel", folder=workspace)
    assert sorted((workspace / "store" / "log").iterdir()) == logs  # no worker was started
    assert third.returncode == 1
    assert f"0 tasks computed, {len(TASKS)} reused" in third.stdout
    summary = json.loads((workspace / "strict" / "summary.json").read_text(encoding="utf-8"))
    assert summary["status"] == "pass"
    assert (summary["verdict"]["computation"], summary["verdict"]["wheel"]) == ("yes", "no")
    assert next(c["status"] for c in summary["checks"] if c["id"] == "fe.reach") == "fail"
    user = next(c for c in summary["checks"] if c["id"] == "user_0.relative_l2")
    assert (user["source"], user["role"]) == ("published: Someone, Fig. 1", "finding")
    assert "of the reference ±1 %" in user["tolerance"]
    page = (workspace / "strict" / "report.html").read_text(encoding="utf-8")
    assert "my digitised curve" in page
    unusual = "tolerances.orientation_spread = 5 is unusual for a relative tolerance"
    assert second.stderr.startswith(f"workbench: warning: strict.toml: {unusual}")
    assert summary["warnings"][0].startswith(unusual)
    assert unusual in page


def test_gates_that_the_study_loosened_are_named_beside_the_verdict(first_report: Finished, workspace: Path) -> None:
    """On the page, on the terminal, in summary.md and summary.json; and every gate's tolerance is known as one."""
    words = (
        "4 tolerances are the study's own: tolerances.reach_deflection = 0.006 is looser than the project's own 0.03"
    )
    folder = workspace / "report"
    page, markdown = ((folder / name).read_text(encoding="utf-8") for name in ("report.html", "summary.md"))
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    assert words in html.unescape(page)
    assert words in markdown
    assert words in " ".join(first_report.stdout.split())
    assert len(summary["warnings"]) == 4
    gates = [statement_of(c["id"], c["quantity"], c["title"]).setting for c in summary["checks"] if c["role"] == "gate"]
    assert set(gates) - {""} <= GATES.keys()
