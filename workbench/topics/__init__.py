"""Questions of the report, each with its tasks, checks, figures and section."""
