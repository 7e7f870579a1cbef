"""A data set is checked and repaired: files against the manifest, labels against signals."""
