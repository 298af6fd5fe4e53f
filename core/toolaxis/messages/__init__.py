"""Sentences of the program in other languages: a catalogue for each, and the one function that looks them up."""
