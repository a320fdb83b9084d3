"""The command line `tactr`. This module imports nothing heavy, so that help is there at once."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from tactr.cli.help_text import COMMANDS, HELP

USER_ERROR = 2


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code: 0, or 2 for a mistake of the user's or a solve that did
    not converge."""
    tokens = list(sys.argv[1:] if arguments is None else arguments)
    if tokens in ([], ["help"]) or "--help" in tokens or "-h" in tokens:
        print(COMMANDS.get(tokens[0], HELP) if tokens else HELP, end="")
        return 0
    from tactr.cli.run import run

    return run(tokens)
