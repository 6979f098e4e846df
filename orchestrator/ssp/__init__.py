"""Systems as .ssp files (System Structure and Parameterization): written as SSP 1.0, read as 1.0 and 2.0."""
