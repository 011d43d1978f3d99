"""``python -m workbench``, and what the command ``workbench`` calls: Ctrl-C is heard while the rest is loaded, too."""

from __future__ import annotations

import os

__all__ = ["main"]


def main() -> None:
    """Run the command line; until it is loaded, Ctrl-C ends the process at once."""
    try:
        import signal

        if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGINT, _end)
        from workbench.execution.standard_streams import forget_odd_widths, name_errors, open_closed_streams

        open_closed_streams()
        name_errors()
        forget_odd_widths()
        from workbench.cli import main as run
    except KeyboardInterrupt:  # before the handler was there
        _end()
    run()


def _end(*_: object) -> None:
    os.write(2, b"workbench: error: interrupted; nothing was begun\n")
    os._exit(2)


if __name__ == "__main__":
    main()
