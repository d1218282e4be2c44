"""The skin of closing lids, which no picture of an open eye shows."""
