"""The independent judge: material removal from the cutter location data alone.

`verdict` sums up; `maps` measures faces; `removal` meets rays with the swept cutter; `axes` measures the room around
cutter, shank and holder.
"""
