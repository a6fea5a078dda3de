"""What is done with a ground motion before and beside a frame: processing, intensity, spectra."""
