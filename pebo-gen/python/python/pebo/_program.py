"""The program ``pebo-gen``: the command line of the generator, in this process."""

from __future__ import annotations

import signal
import sys

from . import _pebo


def main() -> int:
    """Run the command of the process's arguments, and give its exit status."""
    # Python notes Ctrl-C and goes on until the command returns; a program ends.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _pebo.program(["pebo-gen", *sys.argv[1:]])
