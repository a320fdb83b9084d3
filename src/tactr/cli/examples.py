"""The command `examples`."""

from __future__ import annotations

from tactr import examples


def run_examples(name: str | None) -> int:
    """List the examples, one line each, or print the file of one. Raises FileError for an unknown name."""
    if name is not None:
        print(examples.path(name).read_text(encoding="utf-8"), end="")
        return 0
    width = max(map(len, examples.names()))
    for known in examples.names():
        print(f"{known:{width}}  {examples.summary(known)}")
    print("\ntactr solve NAME solves one; tactr examples NAME > my_robot.yaml starts a file of your own.")
    return 0
