"""Reading a finished data set: runs, signals, touches, replays."""
