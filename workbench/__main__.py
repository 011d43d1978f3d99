"""``python -m workbench``, and what the command ``workbench`` calls: Ctrl-C is heard while the rest is loaded, too."""

from __future__ import annotations

__all__ = ["main"]


def main() -> None:
    """Run the command line."""
    try:
        from workbench.cli import main as run
    except KeyboardInterrupt:
        import sys

        sys.stderr.write("workbench: error: interrupted; nothing was begun\n")
        sys.exit(2)
    run()


if __name__ == "__main__":
    main()
