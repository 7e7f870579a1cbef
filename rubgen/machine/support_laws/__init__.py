"""The support of the disk centre and its laws, one file a law; `disk_support` registers them."""
