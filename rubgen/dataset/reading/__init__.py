"""A finished data set is read: runs, signals, touches, replays."""
