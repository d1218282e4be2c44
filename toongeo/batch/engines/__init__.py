"""On what the pictures of a batch are worked: one adapter a backend."""
