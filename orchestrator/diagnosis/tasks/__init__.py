"""What a crew is asked to do: predictions, slopes, and fits. Each is a picklable object that is called with a lander."""
