"""Command line, study files, task graph and result store, comparison, figures and report."""
