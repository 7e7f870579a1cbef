"""Runs in files: MCAP and Parquet."""
