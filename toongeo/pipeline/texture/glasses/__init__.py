"""Parts of the search for glasses."""
