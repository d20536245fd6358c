"""Grammar: RCL trees, the PCFG Π and the chart that reads a sentence in a scene (thesis chapter 5)."""
