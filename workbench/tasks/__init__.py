"""What workers run: one function a task, importing what it needs."""
