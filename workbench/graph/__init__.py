"""From a study to the tasks that compute it."""
