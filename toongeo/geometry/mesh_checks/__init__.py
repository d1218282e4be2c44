"""Parts of the search for self-intersections."""
