"""Saying: sentences for what is seen, in the words and the grammar that were learned."""
