"""No command opens a connection, and none writes outside its output folder and its store.

Every Python process of a command, workers included, reports what it opens to write and whom it calls, by an audit hook
that its start installs (``sitecustomize``). Caches of compiled code and of fonts, which belong to the libraries, do not
count; pipes between processes of this machine do not either.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
from pathlib import Path

import pytest

from tests.end_to_end.small_study import ROOT, command, environment, small_study_text
from tests.small_report_folder import write_small_report

HOOK = """
import os, sys
_log = os.open(os.environ["AUDIT_LOG"], os.O_WRONLY | os.O_APPEND | os.O_CREAT)
_WRITES = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_TRUNC
_PATHS = {"os.mkdir": 0, "os.rename": 1, "os.remove": 0, "os.rmdir": 0, "os.symlink": 1, "os.link": 1, "os.truncate": 0}
def _say(kind, what):
    try:
        os.write(_log, f"{kind} {os.path.abspath(os.fsdecode(what))}\\n".encode())
    except (TypeError, ValueError):
        pass
def _hear(event, arguments):
    if event == "open" and isinstance(arguments[0], (str, bytes)):
        mode, flags = arguments[1], arguments[2]
        if (isinstance(mode, str) and set(mode) & set("wax+")) or (isinstance(flags, int) and flags & _WRITES):
            _say("write", arguments[0])
    elif event in _PATHS:
        beside = arguments[-1] if isinstance(arguments[-1], int) and event != "os.truncate" else -1
        base = os.readlink(f"/proc/self/fd/{beside}") if beside >= 0 else ""  # names relative to an open folder
        _say("write", os.path.join(base, os.fsdecode(arguments[_PATHS[event]])))
    elif event in ("socket.connect", "socket.sendto", "socket.bind") and isinstance(arguments[1], tuple):
        os.write(_log, f"network {event} {arguments[1]}\\n".encode())
    elif event in ("socket.getaddrinfo", "socket.gethostbyname"):
        os.write(_log, f"network {event} {arguments[0]}\\n".encode())
sys.addaudithook(_hear)
"""
SWEEP = '[sweep]\nmodels = ["brush"]\nbase = false\n"brush.friction_max" = [0.757]\n'
CURVE = "deflection_m,load_N\n0,0\n0.01,80\n0.02,165\n"


def _hooked(folder: Path) -> dict[str, str]:
    """Environment in which a command writes the audit's log ``folder/hook/log.txt``, empty at first."""
    (folder / "hook").mkdir(exist_ok=True)
    (folder / "hook" / "sitecustomize.py").write_text(HOOK, encoding="utf-8")
    log = folder / "hook" / "log.txt"
    log.write_text("", encoding="utf-8")
    known = environment()
    return known | {"AUDIT_LOG": str(log), "PYTHONPATH": f"{folder / 'hook'}{os.pathsep}{known['PYTHONPATH']}"}


def _audited(folder: Path, *arguments: str | Path) -> list[str]:
    """Lines of the audit's log of one command that must succeed."""
    known = _hooked(folder)
    ended = subprocess.run(command(*arguments), cwd=folder, env=known, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr
    return _lines(folder)


def _lines(folder: Path) -> list[str]:
    return (folder / "hook" / "log.txt").read_text(encoding="utf-8").splitlines()


def _strays(lines: list[str], *allowed: Path) -> list[str]:
    """Calls, and writes to places that are neither ``allowed`` nor a library's cache."""
    found = []
    for line in lines:
        kind, _, place = line.partition(" ")
        path = Path(place)
        inside = any(path.is_relative_to(folder.absolute()) for folder in allowed)
        cache = {"__pycache__", ".cache", ".config", "matplotlib"} & set(path.parts) or path.is_relative_to("/dev")
        made = any(folder.absolute().is_relative_to(path) for folder in allowed)  # folders on the way, and mkdir -p
        if kind == "network" or not (inside or cache or made):
            found.append(line)
    return found


@pytest.mark.parametrize(
    "name", ["compare", *(pytest.param(one, marks=pytest.mark.long) for one in ("stiffness", "mesh", "rover", "sweep"))]
)
def test_commands_stay_at_home(tmp_path: Path, name: str) -> None:
    """Folders with a blank and letters of other alphabets, as users have them."""
    home = tmp_path / "Räder und Reifen 火星"
    home.mkdir()
    (home / "кривая 1.csv").write_text(CURVE, encoding="utf-8")
    (home / "étude.toml").write_text(f"{small_study_text()}\n{SWEEP}", encoding="utf-8")
    shutil.copy(ROOT / "studies" / "first.toml", home / "малое колесо.toml")
    out, store = home / "résultats", home / "запас"
    arguments: dict[str, tuple[str | Path, ...]] = {
        "compare": ("compare", home / "кривая 1.csv", home / "кривая 1.csv", "--out", out),
        "stiffness": ("stiffness", home / "étude.toml", "--model", "brush", "--out", out, "--store", store),
        "mesh": ("mesh", home / "малое колесо.toml", "--out", out, "--store", store),
        "sweep": ("sweep", home / "étude.toml", "--out", out, "--store", store),
        "rover": ("rover", "static", "--out", out, "--store", store),
    }
    lines = _audited(tmp_path, *arguments[name])
    assert _strays(lines, out, store) == []
    assert any(str(out) in line for line in lines)  # the hook has seen what the command wrote
    assert any(out.rglob("*.*"))


def test_the_viewer_listens_on_loopback_and_writes_nothing(tmp_path: Path) -> None:
    """Two sockets are bound, the probe's and the server's, both to this machine alone; nobody is called."""
    write_small_report(tmp_path / "résultats")
    arguments = command("view", tmp_path / "résultats")
    process = subprocess.Popen(
        arguments, cwd=tmp_path, env=_hooked(tmp_path), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    address = process.stdout.readline()
    process.send_signal(signal.SIGINT)
    _, message = process.communicate()
    assert (process.returncode, message) == (0, ""), address
    strays = _strays(_lines(tmp_path))
    assert strays
    assert [line for line in strays if not line.startswith("network socket.bind ('127.0.0.1', ")] == []


def test_negative_control_strays_are_seen(tmp_path: Path) -> None:
    """The hook sees a file, a folder, a connection, and each also in a process started by the first."""
    deed = "import socket, os; open('stray.txt', 'w').close(); os.mkdir('f'); socket.socket().connect(('127.0.0.1', 9))"
    (tmp_path / "sitecustomize.py").write_text(HOOK, encoding="utf-8")
    log = tmp_path / "log.txt"
    code = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {deed!r}], check=False)"
    known = os.environ | {"AUDIT_LOG": str(log), "PYTHONPATH": str(tmp_path)}
    subprocess.run([*command()[:1], "-c", code], cwd=tmp_path, env=known, capture_output=True, check=True)
    strays = _strays(log.read_text(encoding="utf-8").splitlines(), tmp_path / "out")
    assert any(line.endswith("stray.txt") for line in strays)
    assert any(line.endswith("/f") for line in strays)
    assert any(line.startswith("network socket.connect") for line in strays)
