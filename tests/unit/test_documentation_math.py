"""Formulas of the manual: LaTeX to MathML, and what is not read is said."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from types import ModuleType
from xml.etree import ElementTree

import pytest

DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture(scope="module")
def latex() -> ModuleType:
    spec = importlib.util.spec_from_file_location("latex_mathml", DOCS / "hooks" / "latex_mathml.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("a_i", "<msub><mi>a</mi><mi>i</mi></msub>"),
        ("J_0^{-T}", "<msubsup><mi>J</mi><mn>0</mn><mrow><mo>−</mo><mi>T</mi></mrow></msubsup>"),
        (r"\frac{d}{\theta}", "<mfrac><mrow><mi>d</mi></mrow><mrow><mi>θ</mi></mrow></mfrac>"),
        (r"\tfrac12", '<mstyle displaystyle="false"><mfrac><mn>1</mn><mn>2</mn></mfrac></mstyle>'),
        (r"\sum_i x", "<munder><mo>∑</mo><mi>i</mi></munder><mi>x</mi>"),
        (r"\ddot z", '<mover><mi>z</mi><mo stretchy="false" mathsize="100%">¨</mo></mover>'),
        (r"\text{at node (0, 0)}", "<mtext>at\xa0node\xa0(0,\xa00)</mtext>"),
        (r"1.25 \le x", "<mn>1.25</mn><mo>≤</mo><mi>x</mi>"),
    ],
)
def test_one_formula(latex: ModuleType, formula: str, expected: str) -> None:
    assert latex.mathml(formula, display=False) == f'<math display="inline"><mrow>{expected}</mrow></math>'


def test_brackets_and_tables_keep_their_rows(latex: ModuleType) -> None:
    math = latex.mathml(r"\left[ \begin{bmatrix} M & C \\ C & 0 \end{bmatrix} \right]", display=True)
    assert (math.count("<mtr>"), math.count("<mtd>")) == (2, 4)
    ElementTree.fromstring(math)


def test_a_tag_is_the_number_beside_the_formula(latex: ModuleType) -> None:
    math = latex.mathml(r"E = 0 \tag{2.10, mended}", display=True)
    assert math.endswith('<span class="equation-number">(2.10, mended)</span></div>')


@pytest.mark.parametrize("formula", [r"\unheard x", r"\frac{1}", r"{a", r"\left( a", r"\begin{bmatrix} a"])
def test_what_is_not_read_is_said(latex: ModuleType, formula: str) -> None:
    with pytest.raises(latex.UnknownLatexError):
        latex.mathml(formula, display=False)


def test_every_formula_of_the_manual_is_read(latex: ModuleType) -> None:
    found = 0
    for page in DOCS.rglob("*.md"):
        text = re.sub(r"```.*?```|`[^`\n]*`", "", page.read_text(encoding="utf-8"), flags=re.S)
        for formula in re.findall(r"\$\$(.+?)\$\$", text, flags=re.S) + re.findall(
            r"(?<![$\\])\$([^$\s](?:[^$]*?[^$\s])?)\$(?!\$)", re.sub(r"\$\$.+?\$\$", "", text, flags=re.S)
        ):
            ElementTree.fromstring(latex.mathml(formula, display=True))
            found += 1
    assert found > 100
