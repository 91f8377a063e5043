"""Pictures of recordings: `make pictures` renders those in docs/, in rerun's own viewer without a screen."""
