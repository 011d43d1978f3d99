"""Nothing listens beyond loopback unless asked: every socket of a command's processes, looked up while it runs."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from reference_fe.solver.loopback import keep_to_this_machine
from tests.end_to_end.small_study import command, environment, small_study_text
from tests.listening import heard_beyond, heard_while, listening

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the tables of sockets are Linux'")
CLUSTER = """
from distributed import LocalCluster
if __name__ == "__main__":
    from tests.listening import heard_beyond, listening
    import os
    with LocalCluster(n_workers=1, dashboard_address="127.0.0.1:0", silence_logs=False) as cluster:
        found = listening(os.getpid())
    assert found and not heard_beyond(found), found
"""


@pytest.mark.long
@pytest.mark.parametrize("ranks", [1, 2])
def test_finite_elements_listen_nowhere_else(tmp_path: Path, ranks: int) -> None:
    (tmp_path / "study.toml").write_text(small_study_text(), encoding="utf-8")
    arguments = ("stiffness", "study.toml", "--model", "fe", "--out", "out", "--store", "store", "--ranks", str(ranks))
    with (tmp_path / "said").open("w", encoding="utf-8") as said:
        process = subprocess.Popen(
            command(*arguments), cwd=tmp_path, env=environment(), stdout=said, stderr=said, text=True
        )
        found = heard_while(process)
    assert process.wait() == 0, (tmp_path / "said").read_text(encoding="utf-8")
    assert (tmp_path / "out" / "curves" / "fe_phi000.csv").exists()
    assert heard_beyond(found) == set()


def test_a_cluster_on_this_machine_listens_here_alone(tmp_path: Path) -> None:
    (tmp_path / "cluster.py").write_text(CLUSTER, encoding="utf-8")
    ended = subprocess.run(
        [sys.executable, "cluster.py"], cwd=tmp_path, env=environment(), capture_output=True, text=True
    )
    assert ended.returncode == 0, ended.stderr


@pytest.mark.parametrize(("host", "beyond"), [("0.0.0.0", True), ("127.0.0.1", False)])
def test_negative_control_a_listener_of_a_child_is_heard(host: str, beyond: bool) -> None:
    child = f"import socket, sys; s = socket.create_server(('{host}', 0)); print(flush=True); sys.stdin.read()"
    code = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {child!r}])"
    with subprocess.Popen(
        [sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as one:
        assert one.stdout is not None
        one.stdout.readline()
        found = listening(one.pid)
        one.communicate("")
    assert found == {("tcp", host)}
    assert bool(heard_beyond(found)) is beyond


def test_who_asks_for_another_way_is_left_alone() -> None:
    asked = {"UCX_NET_DEVICES": "eth0"}
    keep_to_this_machine(asked)
    assert asked["UCX_NET_DEVICES"] == "eth0"
    assert "UCX_TLS" not in asked
    assert asked["FI_TCP_IFACE"] == "lo"
