"""How plots are drawn: as SVG text to stand inside a page, whose colours their lines and letters take, or as a PNG.

No text of a case or a dataset is drawn: titles and legends belong to the page.
"""

from __future__ import annotations

import io
import re
from collections.abc import Callable

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure

INK = "#0a0b0c"  # stands for the page's text colour, which Matplotlib cannot know
PER_INCH = 96  # CSS pixels
PNG_PER_INCH = 192
STYLE = {
    "svg.fonttype": "none",
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.alpha": 0.18,
    "grid.color": INK,
    "legend.frameon": False,
    **{key: INK for key in ("text.color", "axes.edgecolor", "axes.labelcolor", "xtick.color")},
    "ytick.color": INK,
}


def svg(draw: Callable[[Axes], None], size_px: tuple[int, int]) -> str:
    """The drawing of `draw(axes)`, as an <svg> element that scales with its surroundings."""
    return svg_figure(lambda figure: draw(figure.add_subplot()), size_px)


def svg_figure(draw: Callable[[Figure], None], size_px: tuple[int, int]) -> str:
    """As `svg`, for a drawing of several plots: `draw(figure)`."""
    text = io.StringIO()
    with matplotlib.rc_context(STYLE):
        _figure(draw, size_px).savefig(text, format="svg", transparent=True)
    content = text.getvalue()
    content = content[content.index("<svg") :]
    content = re.sub(r"<metadata>.*?</metadata>|<style.*?</style>", "", content, flags=re.DOTALL)
    return content.replace(INK, "currentColor")


def svg_file(draw: Callable[[Figure], None], size_px: tuple[int, int]) -> bytes:
    """The drawing of `draw(figure)` as an SVG file that stands alone, dark on white; the same drawing gives the same bytes."""
    content = io.BytesIO()
    with matplotlib.rc_context(STYLE | {"svg.hashsalt": "crossdem"}):
        _figure(draw, size_px).savefig(content, format="svg", metadata={"Date": None})
    return content.getvalue()


def png_figure(draw: Callable[[Figure], None], size_px: tuple[int, int]) -> bytes:
    """The drawing of `draw(figure)` as a PNG, dark on white: for where no page gives the colours."""
    content = io.BytesIO()
    with matplotlib.rc_context(STYLE):
        _figure(draw, size_px).savefig(content, format="png", dpi=PNG_PER_INCH)
    return content.getvalue()


def _figure(draw: Callable[[Figure], None], size_px: tuple[int, int]) -> Figure:
    figure = Figure(figsize=[length / PER_INCH for length in size_px], layout="constrained")
    draw(figure)
    return figure
