"""What holds and what does not: rules, their words, the baseline of CI. Knows records alone, no question."""
