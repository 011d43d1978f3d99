"""What the report answers, one folder a question: tasks, results, checks, figures, words and section."""
