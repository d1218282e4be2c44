"""What a picture looks like once it is drawn: smoothed along its edges, in few colours and tones."""
