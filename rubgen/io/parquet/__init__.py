"""Runs as Parquet."""
