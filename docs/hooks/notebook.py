"""Runs a notebook without Jupyter and keeps what its cells show: printed lines, a last value, pyplot's pictures.

    python docs/hooks/notebook.py docs/fe_wheel.ipynb        runs it in its folder and writes its outputs anew

Verified by tests/end_to_end/test_notebook.py.
"""

from __future__ import annotations

import ast
import base64
import contextlib
import io
import json
import os
import sys
from pathlib import Path
from typing import Any

DOTS_PER_INCH = 80


def run(notebook: dict[str, Any], folder: Path) -> dict[str, Any]:
    """The notebook with its code cells run in order, in one namespace; an error of a cell is raised."""
    names: dict[str, Any] = {"__name__": "__main__"}
    done, number = [], 0
    with contextlib.chdir(folder):
        for cell in notebook["cells"]:
            if cell["cell_type"] == "code":
                number += 1
                outputs = _outputs("".join(cell["source"]), names, number)
                cell = {**cell, "execution_count": number, "outputs": outputs}
            done.append(cell)
    return {**notebook, "cells": done}


def text_of(notebook: dict[str, Any]) -> str:
    """The content of the file."""
    return json.dumps(notebook, indent=1, ensure_ascii=False) + "\n"


def _outputs(source: str, names: dict[str, Any], number: int) -> list[dict[str, Any]]:
    *body, last = ast.parse(source).body
    printed, value = io.StringIO(), None
    with contextlib.redirect_stdout(printed):
        if isinstance(last, ast.Expr):
            exec(compile(ast.Module(body, []), f"cell {number}", "exec"), names)
            value = eval(compile(ast.Expression(last.value), f"cell {number}", "eval"), names)
        else:
            exec(compile(source, f"cell {number}", "exec"), names)
    found: list[dict[str, Any]] = []
    if text := printed.getvalue():
        found.append({"output_type": "stream", "name": "stdout", "text": text.splitlines(keepends=True)})
    if value is not None:
        data = {"text/plain": repr(value).splitlines(keepends=True)}
        if hasattr(value, "_repr_html_"):
            data["text/html"] = value._repr_html_().splitlines(keepends=True)
        found.append({"output_type": "execute_result", "execution_count": number, "metadata": {}, "data": data})
    return found + _pictures()


def _pictures() -> list[dict[str, Any]]:
    """What stands in pyplot, as PNG; pyplot is empty afterwards."""
    from matplotlib import pyplot

    found = []
    for figure in map(pyplot.figure, pyplot.get_fignums()):
        stream = io.BytesIO()
        figure.savefig(stream, format="png", dpi=DOTS_PER_INCH, metadata={"Software": None})
        picture = base64.b64encode(stream.getvalue()).decode("ascii")
        found.append({"output_type": "display_data", "metadata": {}, "data": {"image/png": picture}})
    pyplot.close("all")
    return found


if __name__ == "__main__":
    os.environ.setdefault("MPLBACKEND", "Agg")
    (path,) = map(Path, sys.argv[1:])
    path.write_text(text_of(run(json.loads(path.read_text(encoding="utf-8")), path.parent)), encoding="utf-8")
