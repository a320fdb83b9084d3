"""The colours of tubes, the same in every picture: Okabe and Ito's, which colour-blind people tell apart."""

TUBE_COLOURS = (
    "#0072B2",  # blue: outermost
    "#D55E00",  # vermillion
    "#009E73",  # bluish green
    "#E69F00",  # orange
    "#56B4E9",  # sky blue
    "#CC79A7",  # reddish purple
    "#B8A800",  # yellow, darkened to show on white
    "#555555",  # grey
)
GUIDE_COLOUR = "#9A9A9A"
MARK_COLOUR = "#222222"


def tube_colour(index: int) -> str:
    """The colour of a tube, outermost 0."""
    return TUBE_COLOURS[index % len(TUBE_COLOURS)]


def mixed(colour: str, other: str, share: float) -> str:
    """`colour` with this share of `other` mixed in, both as "#rrggbb"."""
    pairs = ((int(colour[k : k + 2], 16), int(other[k : k + 2], 16)) for k in (1, 3, 5))
    return "#" + "".join(f"{round((1 - share) * a + share * b):02x}" for a, b in pairs)
