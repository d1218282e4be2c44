"""What `make_avatar` does between its stages: another rig, drawn pictures, hair, heads beyond what the method bears."""
