"""A Dask scheduler and its workers as processes on loopback, and a link to it that can be cut."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from tests.end_to_end.small_study import environment

HANGING = 300.0
"""No step of these tests takes a tenth of this time on a busy machine [s]: only to end what hangs."""
_LOOPBACK = "127.0.0.1"


def wait_for(condition: Callable[[], object], what: str) -> None:
    """Wait until it holds."""
    end = time.monotonic() + HANGING
    while not condition():
        assert time.monotonic() < end, f"{what}: in vain"
        time.sleep(0.02)


def free_port() -> int:
    """A port of loopback that nobody listens on."""
    with socket.socket() as taken:
        taken.bind((_LOOPBACK, 0))
        return int(taken.getsockname()[1])


class Cluster:
    """A scheduler on a port that it keeps when it is started again, and workers without a nanny.

    Parameters
    ----------
    folder : for the processes' own files and their log
    """

    def __init__(self, folder: Path) -> None:
        self.folder, self.port = folder, free_port()
        self.address = f"tcp://{_LOOPBACK}:{self.port}"
        self.workers: list[subprocess.Popen[bytes]] = []
        self.scheduler = self._started_scheduler()
        wait_for(self._answers, "the scheduler")

    def start_scheduler(self) -> None:
        """Another scheduler in the place of the one that was killed."""
        self.scheduler.wait(HANGING)
        self.scheduler = self._started_scheduler()

    def _answers(self) -> bool:
        with suppress(OSError):
            socket.create_connection((_LOOPBACK, self.port)).close()
            return True
        return False

    def add_worker(self) -> subprocess.Popen[bytes]:
        """One more worker."""
        options = ("--host", _LOOPBACK, "--nthreads", "1", "--no-nanny", "--dashboard-address", f"{_LOOPBACK}:0")
        self.workers.append(self._started("dask_worker", self.address, *options))
        return self.workers[-1]

    def close(self) -> None:
        """End every process."""
        for process in (self.scheduler, *self.workers):
            with suppress(ProcessLookupError):
                process.send_signal(signal.SIGCONT)
            process.kill()
            process.wait(HANGING)

    def _started_scheduler(self) -> subprocess.Popen[bytes]:
        where = ("--host", _LOOPBACK, "--port", str(self.port), "--dashboard-address", f"{_LOOPBACK}:0")
        return self._started("dask_scheduler", *where)

    def _started(self, name: str, *arguments: str) -> subprocess.Popen[bytes]:
        line = [sys.executable, "-m", f"distributed.cli.{name}", *arguments]
        with (self.folder / "cluster.log").open("ab") as log:
            return subprocess.Popen(line, cwd=self.folder, env=environment(), stdout=log, stderr=log)


class Link:
    """Carries connections of loopback to a port, until it is cut: those that stand break, new ones are refused.

    Parameters
    ----------
    port : where it leads to
    """

    def __init__(self, port: int) -> None:
        self._port, self._ends = port, list[socket.socket]()
        self._door = self._listening(0)
        self.port = int(self._door.getsockname()[1])
        self.address = f"tcp://{_LOOPBACK}:{self.port}"

    def cut(self) -> None:
        """Break what stands and refuse what comes."""
        for end in (self._door, *self._ends):
            with suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)
            end.close()
        self._ends.clear()

    def mend(self) -> None:
        """Carry again what comes from now on."""
        self._door = self._listening(self.port)

    def _listening(self, port: int) -> socket.socket:
        door = socket.create_server((_LOOPBACK, port))
        threading.Thread(target=self._admit, args=(door,), daemon=True).start()
        return door

    def _admit(self, door: socket.socket) -> None:
        with suppress(OSError):
            while True:
                near, _ = door.accept()
                far = socket.create_connection((_LOOPBACK, self._port))
                self._ends += [near, far]
                for one, other in ((near, far), (far, near)):
                    threading.Thread(target=_carry, args=(one, other), daemon=True).start()


def _carry(one: socket.socket, other: socket.socket) -> None:
    with suppress(OSError):
        while data := one.recv(65536):
            other.sendall(data)
    for end in (one, other):
        with suppress(OSError):
            end.shutdown(socket.SHUT_RDWR)


def stop(process: subprocess.Popen[bytes]) -> None:
    """Let a process stand still, its connections open."""
    os.kill(process.pid, signal.SIGSTOP)


def go_on(process: subprocess.Popen[bytes]) -> None:
    """Let it go on."""
    os.kill(process.pid, signal.SIGCONT)
