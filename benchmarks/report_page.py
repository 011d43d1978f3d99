"""How large the report's page is and how soon it shows, beside Plotly's own page with its first figure alone.

``make bench NAME=report_page`` opens ``build/report/report.html`` (or the page that ARGS names) in headless Chromium,
on a desktop's and a phone's width, prints the table and writes ``build/bench/report_page.json``. Times are the
browser's own marks, the smallest of five loads, taken in turn: what else the machine does slows any of them. The aim is
3 s until verdict and first figure are drawn. The peer is the same figure in a page by ``Figure.write_html``, with all
of Plotly inside.
"""

from __future__ import annotations

import argparse
import json
import re
import shutil
import sys
import tempfile
from pathlib import Path

import plotly.graph_objects as go  # type: ignore[import-untyped]
from playwright.sync_api import Browser, sync_playwright

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from benchmarks.output.run import Run, add_option  # noqa: E402

SCREENS = {"desktop": (1400, 900), "phone": (390, 844)}
LOADS = 5
AIM_S = 3.0
DRAWN = 'performance.getEntriesByName("first-figure")[0]?.startTime'


def peer_page(page: Path, target: Path) -> None:
    """The page's first figure by Plotly's own writer, which notes when it is drawn."""
    found = re.search(r'data-for="model-curves">(.*?)</script>', page.read_text(encoding="utf-8"), re.DOTALL)
    if found is None:
        raise SystemExit(f"report_page: {page} has no figure model-curves; give the page that workbench report wrote")
    figure = go.Figure(json.loads(found[1].replace("<\\/", "</")))
    figure.write_html(target, include_plotlyjs=True, post_script='performance.mark("first-figure");')


def shown(browser: Browser, page: Path, screen: tuple[int, int]) -> float:
    """Time [s] from the start of loading until the first figure is drawn."""
    tab = browser.new_page(viewport={"width": screen[0], "height": screen[1]})
    tab.goto(page.resolve().as_uri(), wait_until="commit")
    tab.wait_for_function(DRAWN)
    found = 1e-3 * float(tab.evaluate(DRAWN))
    tab.close()
    return found


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("page", type=Path, nargs="?", default=ROOT / "build" / "report" / "report.html")
    add_option(parser)
    options = parser.parse_args()
    chromium = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    if not options.page.is_file() or chromium is None:
        parser.error(f"needs a page ({options.page}; make report) and Chromium on PATH")
    run = Run("report_page")
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as driver:
        pages = (options.page, Path(folder) / "peer.html")
        peer_page(*pages)
        sizes = [page.stat().st_size for page in pages]
        rows: list[dict[str, object]] = [_row("page", "size of the page", "B", *map(float, sizes))]
        browser = driver.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        run.further_versions["Chromium"] = browser.version
        for name, screen in SCREENS.items():
            loads = [[shown(browser, page, screen) for page in pages] for _ in range(LOADS)]
            ours, peer = (min(times) for times in zip(*loads, strict=True))
            rows.append(_row(name, "time to verdict and first figure", "s", ours, peer))
            print(f"{name:<10}{ours:8.2f} s, aim {AIM_S:g} s   Plotly's own page {peer:.2f} s")
        browser.close()
    print(f"page      {sizes[0] / 1e6:8.2f} MB")
    for path in run.write(rows, keep=options.record):
        print(path)


def _row(case: str, metric: str, unit: str, ours: float, peer: float) -> dict[str, object]:
    return {"case": case, "metric": metric, "unit": unit, "ours": ours, "peer": peer, "ratio": peer / ours}


if __name__ == "__main__":
    main()
