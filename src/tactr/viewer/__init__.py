"""The robot in the browser (extra: view)."""

from tactr.viewer.show import show
from tactr.viewer.view import View

__all__ = ["View", "show"]
