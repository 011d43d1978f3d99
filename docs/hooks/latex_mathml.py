"""LaTeX formulas of the manual to MathML when the site is built: no script, no font, nothing fetched by the browser.

Reads the part of LaTeX that docs/ uses; an unknown command ends the build with its name. ``\\tag{2.9}`` becomes the
number at the right. Verified by tests/unit/test_documentation_math.py.
"""

from __future__ import annotations

import re
from html import escape

__all__ = ["UnknownLatexError", "mathml"]

LETTERS = {
    **{"alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "zeta": "ζ", "eta": "η", "theta": "θ", "iota": "ι"},
    **{"kappa": "κ", "lambda": "λ", "mu": "μ", "nu": "ν", "xi": "ξ", "pi": "π", "rho": "ρ", "sigma": "σ"},
    **{"tau": "τ", "phi": "ϕ", "varphi": "φ", "chi": "χ", "psi": "ψ", "omega": "ω", "Gamma": "Γ", "Delta": "Δ"},
    **{"Theta": "Θ", "Lambda": "Λ", "Xi": "Ξ", "Pi": "Π", "Sigma": "Σ", "Phi": "Φ", "Psi": "Ψ", "Omega": "Ω"},
    **{"infty": "∞", "ell": "ℓ"},
}
OPERATORS = {
    **{"cdot": "⋅", "times": "×", "otimes": "⊗", "pm": "±", "to": "→", "leftarrow": "←", "le": "≤", "ge": "≥"},
    **{"ne": "≠", "approx": "≈", "in": "∈", "dots": "…", "sum": "∑", "int": "∫", "prod": "∏"},
    **{"nabla": "∇", "partial": "∂", "{": "{", "}": "}", "lVert": "‖", "rVert": "‖", "|": "‖", "%": "%"},
}
FUNCTIONS = {"sin", "cos", "tan", "sinh", "cosh", "tanh", "ln", "log", "exp", "max", "min", "det"}
ACCENTS = {"dot": "˙", "ddot": "¨", "bar": "¯", "hat": "^", "tilde": "~"}
SPACES = {",": "0.17em", ":": "0.22em", ";": "0.28em", " ": "0.33em", "quad": "1em", "qquad": "2em"}
SIZES = {"bigl": 1.2, "bigr": 1.2, "Bigl": 1.8, "Bigr": 1.8}
TABLES = {"bmatrix": ("[", "]"), "pmatrix": ("(", ")"), "cases": ("{", ""), "aligned": ("", "")}
DOUBLE_STRUCK = {"C": "ℂ", "R": "ℝ"}
WITH_LIMITS = {"\\sum", "\\prod", "\\min", "\\max"}
TOKEN = re.compile(
    r"\\(?:text|operatorname|mathrm|mathbb|tag|begin|end)\{[^{}]*\}|\\[a-zA-Z]+|\\.|\d+(?:\.\d+)?|\S", re.S
)


class UnknownLatexError(ValueError):
    """A command that is not read here, or a brace or pair that is not closed."""


def mathml(latex: str, *, display: bool) -> str:
    """One formula, without its dollar signs, as a <math> element; with a \\tag, a block with the number beside it."""
    reader = _Reader(latex)
    row = reader.row("")
    math = f'<math display="{"block" if display else "inline"}">{row}</math>'
    if not display:
        return math
    number = f'<span class="equation-number">({escape(reader.tag)})</span>' if reader.tag else ""
    return f'<div class="equation">{math}{number}</div>'


def _operator(sign: str, **attributes: str) -> str:
    written = "".join(f' {name}="{value}"' for name, value in attributes.items())
    return f"<mo{written}>{escape(sign)}</mo>"


class _Reader:
    """Recursive descent over the tokens of one formula; its methods return MathML."""

    def __init__(self, latex: str) -> None:
        self.latex, self.at, self.tag = latex, 0, ""
        self.tokens = TOKEN.findall(latex)

    def peek(self) -> str:
        """Next token, empty at the end."""
        return self.tokens[self.at] if self.at < len(self.tokens) else ""

    def take(self, wanted: str = "") -> str:
        """Next token, which is then behind us; raises UnknownLatexError if it is not the one wanted."""
        token = self.peek()
        if not token or (wanted and token != wanted):
            raise UnknownLatexError(f"{wanted or 'more'!r} expected, {token or 'the end'!r} found in {self.latex!r}")
        self.at += 1
        return token

    def row(self, *ends: str) -> str:
        """Terms up to one of ``ends``, which is left to be taken."""
        terms = []
        while self.peek() not in ends:
            terms.append(self.scripted())
        return f"<mrow>{''.join(terms)}</mrow>"

    def scripted(self) -> str:
        """A term with what stands below and above it."""
        with_limits = self.peek() in WITH_LIMITS
        base, below, above = self.term(), "", ""
        while self.peek() in ("_", "^"):
            if self.take() == "_":
                below = self.argument()
            else:
                above = self.argument()
        if not below and not above:
            return base
        name = "munder" * bool(below) + ("over" if below else "mover") * bool(above)
        if not with_limits:
            name = "m" + "sub" * bool(below) + "sup" * bool(above)
        return f"<{name}>{base}{below}{above}</{name}>"

    def argument(self) -> str:
        """What a command or script takes: a group in braces, or one term."""
        if self.peek() != "{":
            token = self.peek()
            if len(token) > 1 and token.isdigit():  # \tfrac12 takes one digit at a time
                self.tokens[self.at : self.at + 1] = list(token)
            return self.term()
        self.take("{")
        inside = self.row("}", "")
        self.take("}")
        return inside

    def term(self) -> str:
        """One token, group or command."""
        token = self.peek()
        if token == "{":
            return self.argument()
        self.take()
        if token.startswith("\\"):
            return self.command(*re.fullmatch(r"\\(.[a-zA-Z]*)(?:\{(.*)\})?", token, re.S).groups())  # type: ignore[union-attr]
        if token[0].isdigit():
            return f"<mn>{token}</mn>"
        if token.isalpha():
            return f"<mi>{token}</mi>"
        if token == "|":
            return _operator("|", stretchy="false", lspace="0", rspace="0")
        if token in "()[]":
            return _operator(token, stretchy="false")
        return _operator({"-": "−", "*": "∗", "'": "′"}.get(token, token))

    def command(self, name: str, braced: str | None) -> str:
        """A command; ``braced`` is the text of those that take plain words."""
        if braced is not None:
            return self.worded(name, braced)
        if name in LETTERS:
            return f"<mi>{LETTERS[name]}</mi>"
        if name in FUNCTIONS:
            return f"<mi>{name}</mi>"
        if name in OPERATORS:
            return _operator(OPERATORS[name])
        if name in SPACES:
            return f'<mspace width="{SPACES[name]}"></mspace>'
        if name in ACCENTS:
            # no accent="true": without a mathematical font Chromium then draws the sign into the letter
            return f"<mover>{self.argument()}{_operator(ACCENTS[name], stretchy='false', mathsize='100%')}</mover>"
        if name in SIZES:
            return _operator(self.bracket(), minsize=f"{SIZES[name]}em", maxsize=f"{SIZES[name]}em")
        if name in ("frac", "tfrac"):
            fraction = f"<mfrac>{self.argument()}{self.argument()}</mfrac>"
            return fraction if name == "frac" else f'<mstyle displaystyle="false">{fraction}</mstyle>'
        if name == "sqrt":
            return f"<msqrt>{self.argument()}</msqrt>"
        if name == "left":
            opening, inside = self.bracket(), self.row("\\right", "")
            self.take("\\right")
            return f"<mrow>{_operator(opening, fence='true')}{inside}{_operator(self.bracket(), fence='true')}</mrow>"
        raise UnknownLatexError(f"\\{name} is not read, in {self.latex!r}: add it to docs/hooks/latex_mathml.py")

    def bracket(self) -> str:
        """A bracket after \\left, \\right or a size; a dot is none."""
        token = self.take()
        return {".": "", "\\{": "{", "\\}": "}", "\\lVert": "‖", "\\rVert": "‖"}.get(token, token)

    def worded(self, name: str, text: str) -> str:
        """A command whose argument is text."""
        if name == "tag":
            self.tag = text
            return ""
        if name == "begin" and text in TABLES:
            return self.table(text)
        if name in ("text", "operatorname", "mathrm"):
            words = escape(text.replace(" ", "\N{NO-BREAK SPACE}"))
            return f"<mtext>{words}</mtext>" if name == "text" else f'<mi mathvariant="normal">{words}</mi>'
        if name == "mathbb" and text in DOUBLE_STRUCK:
            return f"<mi>{DOUBLE_STRUCK[text]}</mi>"
        raise UnknownLatexError(f"\\{name}{{{text}}} is not read, in {self.latex!r}")

    def table(self, kind: str) -> str:
        """Rows up to the \\end of a matrix, of cases, or of aligned lines."""
        end, rows = f"\\end{{{kind}}}", [[""]]
        while self.peek() != end:
            rows[-1][-1] = self.row("&", "\\\\", end, "")
            if self.peek() != end:
                mark = self.take()
                rows[-1].append("") if mark == "&" else rows.append([""])
        self.take(end)
        lines = ("".join(f"<mtd>{cell}</mtd>" for cell in cells) for cells in rows if any(cells))
        body = "".join(f"<mtr>{line}</mtr>" for line in lines)
        opening, closing = (_operator(sign, fence="true") if sign else "" for sign in TABLES[kind])
        return f'<mrow>{opening}<mtable class="{kind}">{body}</mtable>{closing}</mrow>'
