"""Makes damaged shards and single runs of a finished data set again, from its manifest."""
