"""What is done with one picture of a batch, in whichever process."""
