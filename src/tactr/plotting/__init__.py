"""Pictures of shapes; matplotlib (extra: plot) is imported when one is made."""

from tactr.plotting.palette import TUBE_COLOURS, tube_colour
from tactr.plotting.shape_plot import plot_shape

__all__ = ["TUBE_COLOURS", "plot_shape", "tube_colour"]
