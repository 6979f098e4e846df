"""The same landing in MuJoCo, by code that shares nothing with the project's: to check the twin, and to make data for the diagnosis."""
