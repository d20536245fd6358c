"""The commands of `showtell`, one a module; `add_to(app)` adds each to the command line."""
