"""Model files as plain arrays; what is in them is not trusted."""
