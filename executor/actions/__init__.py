"""Actions as motion plans: learned action graphlets played on any robot of the twin."""
