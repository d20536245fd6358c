"""`showtell evaluate execution`: new commands in new scenes, carried out in physics and judged by the truth.

A `Case` is a command in a scene with what should come of it; `run_case` carries it out and gives a `Verdict`.
`board_cases` makes tasks, `suite_cases` what should be answered without a motion, `release_cases` real commands.
"""
