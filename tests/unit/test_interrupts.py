"""Ctrl-C is put off while a compiler is at work or a worker starts, and comes again where it was lost."""

from __future__ import annotations

import subprocess
import sys
import types
from pathlib import Path

import pytest

from workbench.execution.interrupts import delicate

ROOT = Path(__file__).parents[2]
SCRIPT = """
import signal, sys, time
signal.signal(signal.SIGINT, signal.default_int_handler)
from workbench.execution.interrupts import hear_no_more, interrupt_safely
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
    hear_no_more()
    print("interrupted")
"""

LOST = """
import signal, sys, time
signal.signal(signal.SIGINT, signal.default_int_handler)
from workbench.execution.interrupts import hear_no_more, interrupt_safely, put_off
if sys.argv[1] == "safely":
    interrupt_safely()

class Deaf:
    def __del__(self):
        signal.raise_signal(signal.SIGINT)  # compiled code calls this, and cannot pass on what is raised here

def wait(seconds):
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        pass

try:
    with put_off():
        deaf = Deaf()
        del deaf
        wait(0.1)
        print("put off")
    deaf = Deaf()
    del deaf
    wait(1.0)
    print("never")
except KeyboardInterrupt:
    try:
        wait(0.1)
        print("once")
    finally:
        hear_no_more()
signal.raise_signal(signal.SIGINT)
print("heard no more", flush=True)
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
    run = subprocess.run([sys.executable, "-c", SCRIPT, filename], cwd=ROOT, capture_output=True, text=True, check=True)
    assert run.stdout.split("\n")[:-1] == printed


@pytest.mark.parametrize(
    ("how", "printed"), [("safely", ["put off", "once", "heard no more"]), ("plainly", ["put off", "never"])]
)
def test_a_lost_one_comes_again_once_and_in_silence(how: str, printed: list[str]) -> None:
    """Raised in a finaliser, it is lost by Python's own handler (negative control), which also speaks of it."""
    run = subprocess.run([sys.executable, "-c", LOST, how], cwd=ROOT, capture_output=True, text=True, check=False)
    assert run.stdout.split("\n")[:-1] == printed
    assert (run.returncode == 0) == (run.stderr == "") == (how == "safely")
