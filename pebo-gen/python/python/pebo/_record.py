"""Recorded samples as CSV, which the generator reads row by row.

In: a DataFrame, or columns by their names. Out: CSV as bytes. Numbers keep every digit.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping
from typing import Any


def recording(data: Any) -> tuple[str, bytes]:
    """The name of the data in diagnostics, and the data as CSV."""
    if not isinstance(data, Mapping) and not (hasattr(data, "columns") and hasattr(data, "__getitem__")):
        raise TypeError(f"recorded data are a DataFrame, columns by name, or a path, and not {type(data).__name__}")
    names = list(data.columns if hasattr(data, "columns") else data)
    columns = {name: _cells(name, data[name]) for name in names}
    lengths = {len(cells) for cells in columns.values()}
    if len(lengths) > 1:
        shown = ", ".join(f"`{name}` {len(cells)}" for name, cells in columns.items())
        raise ValueError(f"the columns of recorded data differ in length: {shown}")
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(names)
    writer.writerows(zip(*columns.values()))
    return "the data", text.getvalue().encode()


def _cells(name: Any, column: Any) -> list[Any]:
    """The cells of a column: numbers, or dates and times as the generator reads them."""
    import numpy

    values = numpy.asarray(column)
    if values.ndim != 1:
        raise ValueError(f"a column of recorded data has one dimension, and `{name}` has {values.ndim}")
    if values.dtype.kind in "biufM":
        # Instants as text: 2026-11-27T10:00:00.25
        return list(values.astype(str) if values.dtype.kind == "M" else values.astype(float).tolist())
    cells: Iterable[Any] = values.tolist()
    return ["" if cell is None else cell for cell in cells]
