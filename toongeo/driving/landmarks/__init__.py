"""Points of a performer, and the pose that tells most of them."""
