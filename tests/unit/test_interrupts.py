"""Ctrl-C is put off while a compiler is at work, and only then."""

from __future__ import annotations

import subprocess
import sys
import types
from pathlib import Path

import pytest

from workbench.commands.interrupts import delicate

ROOT = Path(__file__).parents[2]
SCRIPT = """
import signal, sys, time
signal.signal(signal.SIGINT, signal.default_int_handler)
from workbench.commands.interrupts import interrupt_safely
interrupt_safely()
text = '''
signal.raise_signal(signal.SIGINT)
print("not inside", flush=True)
'''
try:
    exec(compile(text, sys.argv[1], "exec"))
    until = time.monotonic() + 10.0
    while time.monotonic() < until:
        pass
    print("never")
except KeyboardInterrupt:
    print("interrupted")
"""


def _frame(filename: str) -> types.FrameType:
    """That of a call inside a function of this file."""
    names: dict[str, types.FrameType] = {}
    exec(compile("import sys\n(lambda: names.update(f=sys._getframe()))()", filename, "exec"), {"names": names})
    return names["f"]


@pytest.mark.parametrize("filename", ["lib/numba/core/typeof.py", "lib/llvmlite/binding/executionengine.py"])
def test_a_compiler_is_recognised_anywhere_above(filename: str) -> None:
    assert delicate(_frame(filename))


@pytest.mark.parametrize("filename", ["rover_dynamics/vehicle/vehicle.py", "my_numba/run.py", "<string>"])
def test_other_code_is_not(filename: str) -> None:
    assert not delicate(_frame(filename))
    assert not delicate(None)


@pytest.mark.parametrize(
    ("filename", "printed"), [("lib/numba/a.py", ["not inside", "interrupted"]), ("lib/a.py", ["interrupted"])]
)
def test_the_signal_comes_as_soon_as_the_compiler_has_returned(filename: str, printed: list[str]) -> None:
    run = subprocess.run(
        [sys.executable, "-c", SCRIPT, filename], cwd=ROOT, capture_output=True, text=True, check=True, timeout=60
    )
    assert run.stdout.split("\n")[:-1] == printed
