"""All that a small set says of its good runs, in one table: `runs`, `signals` and `truth` side by side."""

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from rubgen.io.parquet.words import with_words


def whole_table(directory, shard="train-00000"):
    runs = pq.read_table(directory / "runs.parquet")
    columns = {}
    for table in (
        runs.filter(pc.equal(runs["status"], "ok")),
        pq.read_table(directory / f"signals/{shard}.parquet"),
        pq.read_table(directory / f"truth/{shard}.parquet"),
    ):
        columns |= dict(zip(table.column_names, with_words(table).columns, strict=True))
    return pa.table(columns)
