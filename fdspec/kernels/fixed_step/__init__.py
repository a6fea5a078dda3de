"""The study's scheme, with its fixed step."""
