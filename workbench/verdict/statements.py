"""What each check claims, and why its tolerance is what it is: words that stand once for every family of checks.

The words are data, ``statements.toml`` in the folder of each question: an entry ``[[family]]`` has ``id``, where ``*``
stands for what varies, perhaps ``quantity``, the fields of `Statement`, and ``[family.words]`` for what ``*`` is
called. Every check is made by way of `statement_of`; one that no family or more than one knows cannot be made.
Verified by tests/unit/test_workbench_statements.py.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from contracts.errors import InputError

__all__ = ["DATA", "Family", "Statement", "families", "statement_of"]

DATA = Path(__file__).parents[1] / "questions"
"""Each question has its own in ``statements.toml``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Statement:
    """Words of one check.

    Attributes
    ----------
    claim : what holds if it passes, one sentence
    why : why the tolerance is what it is
    paper : thesis or paper the claim goes back to, with figure, equation or section; may be empty
    theory : section of docs/theory.md; may be empty
    tests : files of tests that verify the rule or the model behind it
    broken_by : tests, ``"file::function"``, in which a damaged model or number makes the check fail; no gate without
    setting : key of ``[tolerances]`` in the study file that moves the limit; may be empty
    tasks : patterns of the tasks whose results it rests on; without any, those of its question
    files : patterns of the published curves and series it rests on
    """

    claim: str
    why: str
    paper: str = ""
    theory: str = ""
    tests: tuple[str, ...] = ()
    broken_by: tuple[str, ...] = ()
    setting: str = ""
    tasks: tuple[str, ...] = ()
    files: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Family:
    """Checks that share their words.

    Attributes
    ----------
    ids : patterns of identifiers, ``*`` stands for one character or more
    quantities : quantities it is meant for; any if empty
    words : what ``*`` matched -> how a sentence says it
    statement : the words, in which ``{0}`` stands for the match in words, ``{id}`` for the match itself, ``{key}`` for
        the key of its words; of the check's title ``{what}`` for what stands behind its first colon, ``{said}`` for
        what stands before it and ``{where}`` for what of that stands behind the first comma, ``{phi}`` for the
        degrees it names, as file names write them
    """

    ids: tuple[str, ...]
    quantities: tuple[str, ...]
    words: Mapping[str, str]
    statement: Statement

    def match(self, id: str, quantity: str) -> str | None:
        """What ``*`` stands for in this identifier, the whole without one; None for a check of another family."""
        if self.quantities and quantity not in self.quantities:
            return None
        for pattern in self.ids:
            found = re.fullmatch("(.+)".join(map(re.escape, pattern.split("*"))), id)
            if found is not None:
                return found[1] if found.groups() else id
        return None

    def of(self, matched: str, title: str) -> Statement:
        """The words for one check."""
        said, _, what = title.partition(": ")
        key = self._key(matched)
        names = {"0": self.words.get(key, _plain(matched)), "id": matched, "key": key, "said": said}
        names |= {"what": (what or said).removeprefix("negative control, "), "where": said.partition(", ")[2] or said}
        names["phi"] = _phi(title)

        def filled(text: str) -> str:
            return re.sub(r"\{(0|id|key|said|what|where|phi)\}", lambda found: names[found[1]], text)

        def each(texts: tuple[str, ...]) -> tuple[str, ...]:
            return tuple(filled(text) for text in texts)

        own = self.statement
        return Statement(
            claim=filled(own.claim),
            why=filled(own.why),
            paper=filled(own.paper),
            theory=own.theory,
            tests=each(own.tests),
            broken_by=own.broken_by,
            setting=own.setting,
            tasks=each(own.tasks),
            files=each(own.files),
        )

    def _key(self, matched: str) -> str:
        """The key of the words of what was matched: itself, or the longest that it begins with."""
        begun = [key for key in self.words if f"{matched}_".startswith(f"{key}_")]
        return max(begun, key=len, default=matched)


def _phi(title: str) -> str:
    """``015`` where a title says 15 deg; ``*``, any, where it names no orientation."""
    found = re.search(r"(\d+)(\.\d+)? deg\b", title)
    return "*" if found is None else f"{int(found[1]):03d}{found[2] or ''}"


def _plain(matched: str) -> str:
    """Part of an identifier in words: ``000`` is 0, ``-40C`` is -40 °C."""
    if re.fullmatch(r"\d+(\.\d+)?", matched):
        return f"{float(matched):g}"
    return re.sub(r"(?<=\d)C\b", " °C", matched.replace("_", " "))


@cache
def families() -> tuple[Family, ...]:
    """Every family of the package's data files."""
    rows = [row for path in sorted(DATA.glob("*/statements.toml")) for row in _rows(path)]
    return tuple(_family(row) for row in rows)


def _rows(path: Path) -> Sequence[Mapping[str, object]]:
    content = tomllib.loads(path.read_text(encoding="utf-8"))
    rows: Sequence[Mapping[str, object]] = content["family"]
    return rows


def _family(row: Mapping[str, object]) -> Family:
    def texts(name: str) -> tuple[str, ...]:
        value = row.get(name, ())
        return (value,) if isinstance(value, str) else tuple(map(str, value))  # type: ignore[call-overload]

    def text(name: str) -> str:
        return " ".join(str(row.get(name, "")).split())

    words = row.get("words", {})
    assert isinstance(words, dict)
    statement = Statement(
        claim=text("claim"),
        why=text("why"),
        paper=text("paper"),
        theory=text("theory"),
        tests=texts("tests"),
        broken_by=texts("broken_by"),
        setting=text("setting"),
        tasks=texts("tasks"),
        files=texts("files"),
    )
    return Family(ids=texts("id"), quantities=texts("quantity"), words=words, statement=statement)


def statement_of(id: str, quantity: str, title: str, known: Sequence[Family] | None = None) -> Statement:
    """The words of a check.

    Raises
    ------
    InputError
        If no family knows the check, or more than one does: the check cannot be made.
    """
    found = [(family, m) for family in known or families() if (m := family.match(id, quantity)) is not None]
    if len(found) != 1:
        rule = f"must be known to one family of workbench/questions/*/statements.toml, is to {len(found)}"
        raise InputError("check", f"{id} ({quantity})", rule, "say there what it claims and why its tolerance is that")
    family, matched = found[0]
    return family.of(matched, title)
