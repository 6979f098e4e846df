"""Sealed cases: landings in which an effect is hidden, their diagnoses, and the score. How to use it: README.md here."""
