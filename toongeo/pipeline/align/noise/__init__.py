"""Parts of `denoise_landmarks`."""
