"""What a picture says for points that are said to be its landmarks: parts of `landmark_evidence`."""
