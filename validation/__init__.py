"""Research on rubgen, not installed: what it is checked against, and how far it can be trusted."""
