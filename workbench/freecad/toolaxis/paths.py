"""Where the clone stands, and what of it the add-on reads."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
RESOURCES = ROOT / "resources"
