"""Buildings in the languages of other programs."""
