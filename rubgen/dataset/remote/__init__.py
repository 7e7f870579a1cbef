"""A data set at a URL: put there file by file, the manifest last."""
