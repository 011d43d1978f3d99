"""MPI keeps to this machine: a library that is told nothing opens ports on the machine's outer address.

All processes of a run are on one machine and meet in shared memory. Who wants another way sets a variable of the same
library himself, and all of them are then left as they are. Verified by tests/end_to_end/test_listening.py.
"""

from __future__ import annotations

import os
from collections.abc import MutableMapping

__all__ = ["keep_to_this_machine"]

_SETTINGS: tuple[dict[str, str], ...] = (
    {"UCX_TLS": "self,sm", "UCX_NET_DEVICES": "lo"},  # MPICH of the PyPI wheel
    {"FI_PROVIDER": "shm,tcp", "FI_TCP_IFACE": "lo"},  # MPICH on libfabric
)
"""By library."""


def keep_to_this_machine(environment: MutableMapping[str, str] = os.environ) -> None:
    """Set what MPI reads at its start, before it is loaded."""
    for settings in _SETTINGS:
        if not settings.keys() & environment.keys():
            environment.update(settings)
