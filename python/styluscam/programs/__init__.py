"""From a job document through programs to a machine's text."""
