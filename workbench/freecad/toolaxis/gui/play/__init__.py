"""Operations played in the 3D view: tool, holder and machine on their way, what meets in red."""
