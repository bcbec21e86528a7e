"""The report's page in a headless browser."""
