"""What the 68 landmarks are: their frontal layout, their order, and other schemes."""
