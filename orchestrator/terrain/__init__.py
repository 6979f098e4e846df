"""The ground of a scenario: `[terrain]` read and checked, handed to the units as a file of heights and numbers."""
