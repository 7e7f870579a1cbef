"""Elements and structures against closed forms and the literature."""
