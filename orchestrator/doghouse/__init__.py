"""The Doghouse: the boundaries of the safe landings in the plane of vertical and horizontal speed, over the certified envelope.

`model` is the file's data, `landing` one combination of inputs as overrides and its margins, `search` finds the boundaries, `flying` who
flies and what is kept, `outcome` what it comes to, `picture` and `report` how it is shown.
"""
