"""What mkdocs does besides its own: formulas in MathML, the API reference, the state of the long tests.

The reference is read from the sources without importing them: neither PETSc nor VTK is needed to build the site.
"""

from __future__ import annotations

import ast
import re
import sys
from html import unescape
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File, Files

sys.path.insert(0, str(Path(__file__).parents[2]))
sys.path.insert(0, str(Path(__file__).parent))
from latex_mathml import mathml

from tests.long_run import STATE, state_of

ROOT = Path(__file__).parents[2]
PACKAGES = ("contracts", "geometry", "soil", "reference_fe", "ancf_reduced", "rover_dynamics", "workbench")
UNKNOWN_REFERENCE = re.compile(
    rf'<autoref [^>]*identifier="(?!(?:{"|".join(PACKAGES)})\b)([^"]*)"[^>]*>(.*?)</autoref>', re.S
)
LISTED = re.compile(
    r"(?P<name><b><code>(?:<span[^>]*>)?(?P<word>[^<]*)(?:</span>)?</code></b>)"
    r"(?:\s*\(<code>(?P<words>[^<]*)</code>\))?\s*–\s*"
    r'<div class="doc-md-description">\s*(?P<more>(?:(?!<div).)*?)\s*</div>',
    re.S,
)
FORMULA = re.compile(r'<(div|span) class="arithmatex">\\[(\[](.*?)\\[)\]]</\1>', re.S)


def on_config(config: Any, **_: Any) -> Any:
    """Complete the menu: guides it does not name behind the others, the packages' pages behind the reference's own."""
    (guides,) = [section["How to"] for section in config.nav if "How to" in section]
    (reference,) = [section["Reference"] for section in config.nav if "Reference" in section]
    named = set(re.findall(r"[\w/]+\.md", str(config.nav)))
    docs = Path(config.docs_dir)
    found = [str(path.relative_to(docs)) for folder in (docs, docs / "how_to") for path in sorted(folder.glob("*.md"))]
    guides.extend(page for page in found if page not in named)
    reference.append({"API": ["reference/api.md", *({name: f"reference/api/{name}.md"} for name in packages())]})
    return config


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Say whether the sources are still those of the last run of the long tests."""
    if STATE not in markdown:  # what it takes to know is not to be known for each page
        return markdown
    return markdown.replace(STATE, f"Against these sources the result is **{state_of(ROOT)}**.")


def _in_words(found: re.Match[str]) -> str:
    """One name of a docstring's list: what stands behind its colon are words, and a sentence below the list is none."""
    if not found["words"] and " " in found["word"]:
        return f"{found['word']} {found['more']}"
    if not found["words"]:
        return found.group(0)
    words = re.sub(r"`+([^`]+)`+", r"<code>\1</code>", found["words"])
    return f"{found['name']}: {words} {re.sub(r'</?p>', '', found['more'])}"


def on_page_content(html: str, **_: Any) -> str:
    """Formulas, marked by arithmatex, to MathML; units in brackets, ``E[i] [Pa]``, are no links."""
    html = LISTED.sub(_in_words, UNKNOWN_REFERENCE.sub(r"[\2][\1]", html))
    return FORMULA.sub(lambda found: mathml(unescape(found[2]).strip(), display=found[1] == "div"), html)


def on_files(files: Files, config: Any, **_: Any) -> Files:
    """Add reference/api/NAME.md for every package that holds a public module."""
    for name, modules in packages().items():
        files.append(File.generated(config, f"reference/api/{name}.md", content=page_of(name, modules)))
    return files


def packages() -> dict[str, list[str]]:
    """Package -> its public modules, inner packages apart, in the order in which they may import each other."""
    found: dict[str, list[str]] = {}
    for top in PACKAGES:
        for path in sorted((ROOT / top).rglob("*.py")):
            if not path.stem.startswith("_"):
                package = ".".join(path.relative_to(ROOT).parent.parts)
                found.setdefault(package, []).append(f"{package}.{path.stem}")
    return found


def page_of(package: str, modules: list[str]) -> str:
    """Markdown of one package's page: what it is for, then module by module."""
    initial = ROOT / package.replace(".", "/") / "__init__.py"
    purpose = ast.get_docstring(ast.parse(initial.read_text(encoding="utf-8"))) if initial.is_file() else None
    listed = "".join(f"\n\n::: {module}" for module in modules)
    return f"# {package}\n\n{purpose or ''}{listed}\n"
