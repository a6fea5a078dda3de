"""One oscillator whose spring is bilinear, by exact steps: the engine of inelastic spectra."""
