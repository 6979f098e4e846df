"""Scenarios: read, check, expand, wire. Nothing here loads a binary."""
