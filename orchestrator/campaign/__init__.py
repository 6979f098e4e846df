"""Many landings of one scenario: what varies, who flies them, what is kept.

`landing` is one landing on a worker, `crew` the workers; `orchestrator.campaign.crew.Crew` is all that other searches need.
"""
