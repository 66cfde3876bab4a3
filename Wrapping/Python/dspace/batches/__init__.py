"""Pictures in numbers: drawn by several processes, continued after an interruption."""
