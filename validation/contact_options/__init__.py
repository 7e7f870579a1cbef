"""What the options of contact do to runs, and where the model of contact ends."""
