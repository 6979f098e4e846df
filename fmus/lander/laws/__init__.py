"""Laws: numbers in, numbers out, SI, no clock, no file."""
