"""Benchmarks: each module `bench_*` has `measure()`, which gives rows of name, value, unit and target."""
