"""``toongeo bench all``: the file of all results, put together from texts and from what benchmarks printed."""
