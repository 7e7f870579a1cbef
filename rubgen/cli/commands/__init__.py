"""What each command does: its checks, its work, what it prints. A module is imported when its command is called."""
