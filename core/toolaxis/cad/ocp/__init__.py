"""Open CASCADE through OCP: shapes in, plans out."""
