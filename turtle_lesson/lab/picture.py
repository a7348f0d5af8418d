"""What every plot returns: a figure, and the same in words."""

from __future__ import annotations

import html
import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHARPNESS = 2
"""Pixels drawn for each pixel shown, so that a picture is sharp on a fine screen."""


class Picture:
    """A figure and its exact text: a notebook shows the figure, print and a screen reader give the text.

    `text` is one paragraph. `figure` is a matplotlib Figure, or None where there was nothing to draw: then
    the text says what is missing and what to try.
    """

    def __init__(self, text: str, figure: Figure | None = None) -> None:
        self.text = text
        self.figure = figure

    def __repr__(self) -> str:
        return self.text

    def _ipython_display_(self) -> None:
        """Show the figure, and below it the text, folded: JupyterLab and its static pages give a PNG no alternative text."""
        from IPython.display import display

        bundle = self._repr_mimebundle_()
        data, metadata = bundle if isinstance(bundle, tuple) else (bundle, {})
        display(data, metadata=metadata, raw=True)
        if self.figure is not None:
            words = f"<details><summary>In words</summary><p>{html.escape(self.text)}</p></details>"
            display({"text/html": words}, raw=True)

    def _repr_mimebundle_(self, **options: object) -> Any:
        """What Jupyter shows: PNG and text, and as metadata the size to show and the alternative text."""
        data: dict[str, Any] = {"text/plain": self.text}
        if self.figure is None:
            return data
        width, height = (round(inches * style.DPI) for inches in self.figure.get_size_inches())
        data["image/png"] = self.png()
        return data, {"image/png": {"width": width, "height": height, "alt": self.text}}

    def png(self) -> bytes:
        """The figure as the bytes of a PNG file, the same bytes whenever it is drawn.

        It has 256 colours: a flat drawing needs no more, and a page stores a quarter of the bytes.
        """
        from PIL import Image

        pixels = Image.fromarray(self.pixels())
        stream = io.BytesIO()
        pixels.quantize(256, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE).save(stream, "png")
        return stream.getvalue()

    def pixels(self) -> np.ndarray:
        """The figure as rows of pixels with red, green, blue and opacity, `SHARPNESS` of them for each pixel shown."""
        from matplotlib.backends.backend_agg import FigureCanvasAgg

        figure = self._figure()
        figure.dpi = style.DPI * SHARPNESS
        try:
            with style.applied():
                canvas = FigureCanvasAgg(figure)
                canvas.draw()
                return np.asarray(canvas.buffer_rgba())
        finally:
            figure.dpi = style.DPI

    def save(self, path: str | Path) -> Path:
        """Write the figure to a file in the format of its ending (png, svg, pdf); returns the path."""
        path = Path(path)
        if path.suffix.lower() == ".png":
            path.write_bytes(self.png())
            return path
        without_date: dict[str, dict[str, Any]] = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
        with style.applied():
            self._figure().savefig(path, metadata=without_date.get(path.suffix.lower()))
        return path

    def _figure(self) -> Figure:
        if self.figure is None:
            raise ValueError(f"there is no figure yet, only a text: {self.text}")
        return self.figure
