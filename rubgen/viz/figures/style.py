"""The style of all figures: plain axes with units, one colour and one marker for each class of motion."""

from collections.abc import Iterable, Sequence
from io import BytesIO
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rubgen.labels.labels import Motion
from rubgen.viz.colors import GREY, MOTION_COLORS, VERMILION

INK = "#222222"
MOTION_MARKERS = {
    Motion.STATIC: "v",
    Motion.PERIOD_1: "o",
    Motion.PERIOD_K: "s",
    Motion.QUASI_PERIODIC: "D",
    Motion.UNDECIDED: "P",
    Motion.CHAOTIC: "^",
}


class ShownFigure(Figure):
    """A matplotlib Figure that a notebook shows without pyplot."""

    def _repr_png_(self) -> bytes:
        picture = BytesIO()
        self.savefig(picture, format="png")
        return picture.getvalue()


def new_figure(width: float, height: float) -> Figure:
    """Make an empty figure of `width` x `height` inches, without any state of pyplot."""
    figure = ShownFigure(figsize=(width, height), layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    return figure


def label_axes(axes: Axes, x: str, y: str) -> None:
    """Label the axes with `x` and `y`, which contain the units, and give them a light frame."""
    axes.set_xlabel(x, fontsize=10, color=INK)
    axes.set_ylabel(y, fontsize=10, color=INK)
    axes.tick_params(labelsize=9, colors=INK)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(GREY)


def head(figure: Figure, text: str, warning: str = "") -> None:
    """Write the title `text` above a figure, and `warning` in another colour above its first panel."""
    figure.suptitle(text, fontsize=11, color=INK)
    if warning:
        figure.axes[0].set_title(warning, fontsize=9, color=VERMILION, loc="left")


def note(axes: Axes, text: str) -> None:
    """Write a grey text in the middle of an empty panel."""
    axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", fontsize=11, color=GREY)


def motion_legend(motions: Iterable[str], marker: str | None = None, *, hollow: bool = False) -> list[Line2D]:
    """Make legend entries for the classes of motion in `motions`, in the order of `Motion`.

    Each entry has the marker of its class, or `marker` if given. With `hollow` a further entry says that hollow marks
    have no contact.
    """
    present = [motion for motion in Motion if motion.value in set(motions)]
    marks = [(each.value, MOTION_COLORS[each], marker or MOTION_MARKERS[each], MOTION_COLORS[each]) for each in present]
    marks += [("hollow: no contact", INK, "o", "none")] if hollow else []
    return [
        Line2D([], [], linestyle="none", label=name, color=color, marker=marker, markerfacecolor=fill)
        for name, color, marker, fill in marks
    ]


def save_png(figure: Figure, path: Path, *, dpi: int = 110) -> None:
    """Write `figure` as PNG without a date or version: the same figure always makes the same bytes.

    `dpi` is the number of pixels an inch.
    """
    figure.savefig(path, dpi=dpi, metadata={"Software": None})


def save_figure(figure: Figure, path: Path) -> None:
    """Write `figure` in the format of the ending of `path`: .png, .svg or .pdf, without dates.

    Raises KeyError for any other ending.
    """
    if path.suffix == ".png":
        save_png(figure, path, dpi=150)
    else:
        unset = {".svg": {"Creator": None, "Date": None}, ".pdf": {"CreationDate": None}}
        figure.savefig(path, metadata=unset[path.suffix])


def speeds_in_words(speeds: Sequence[float]) -> str:
    """Write speeds as whole numbers, ascending: "8,656 and 9,569"."""
    return " and ".join(f"{speed:,.0f}" for speed in sorted(speeds))
