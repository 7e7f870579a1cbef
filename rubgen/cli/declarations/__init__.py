"""The commands as users see them: names, options, help. Each function imports its work when it is called."""
