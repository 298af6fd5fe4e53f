"""Commands made known to FreeCAD.

A macro that FreeCAD records while a command runs imports the file that made the command known, by the file's bare name.
Of this file that is `import freecad`, which does no harm wherever the macro runs.
"""

import FreeCADGui


def add_commands(commands):
    """Make commands known, once; their names in the order given.

    Parameters
    ----------
    commands : dict of str to object
        By the names that FreeCAD knows them by.
    """
    known = FreeCADGui.listCommands()
    for name, command in commands.items():
        if name not in known:
            FreeCADGui.addCommand(name, command)
    return list(commands)
