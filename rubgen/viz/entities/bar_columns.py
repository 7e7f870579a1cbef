"""Bars that change over time, as one column: Rerun's own `BarChart.columns` takes one row alone."""

import numpy as np
import pyarrow as pa
import rerun as rr

from rubgen.arrays import FloatArray
from rubgen.measurement.channel import Float32Array


class _Spectra:
    """Rows of values as the column of tensors that bars are made of."""

    def __init__(self, rows: Float32Array) -> None:
        self.rows = rows

    def as_arrow_array(self) -> pa.Array:
        """One tensor a row."""
        return pa.concat_arrays([rr.components.TensorDataBatch(row).as_arrow_array() for row in self.rows])


def send_bars(
    stream: rr.RecordingStream,
    entity: str,
    index: list[rr.TimeColumn],
    values: FloatArray,
    left: FloatArray,
    color: int,
) -> None:
    """Bars of equal width from `left` (n,) on, their heights `values` (rows, n) at the times of `index`."""
    width = np.full(left.size, left[1] - left[0] if left.size > 1 else 1.0)
    whole = rr.BarChart(values[0], abscissa=left, widths=width, color=color).as_component_batches()
    heights = [batch for batch in whole if str(batch.component_descriptor()).endswith(":values")]
    stream.log(entity, [batch for batch in whole if batch not in heights], static=True)
    column = rr.ComponentColumn(heights[0].component_descriptor(), _Spectra(values.astype(np.float32)))
    stream.send_columns(entity, index, [column])
