"""What sentences advise: the words of each advice, of which sentences are made and by which its remedy is found.

A sentence that advises one of these has it by its name, never typed out: `toolaxis.plan.remedies` knows each of them,
so that whoever words one anew words it anew for both.
"""

LARGER_TOLERANCE = "a larger machining tolerance"
SMALLER_CORNER = "a smaller corner radius"
SMALLER_CUTTER = "a smaller cutter"
SMALLER_ONE = "take a smaller one"
SMALLER_TOOL = "a smaller tool"
SLIMMER_TOOL = "a slimmer tool"
LONGER_STICKOUT = "a longer stick-out"
LONGER_TOOL = "a slimmer or longer tool"
LARGER_SCALLOP = "a larger scallop height"
GREATER_SCALLOP = "a greater scallop height"
COARSER_SCALLOP = "a coarser scallop"
SMALLER_SCALLOP = "a smaller scallop height"
DIVIDE = "divide the face"

#: How a sentence goes on after the amount, mm, by which a face stands out: a machining tolerance above that helps.
STANDS_OUT = "mm out over face"
