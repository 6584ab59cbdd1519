"""The designer's page: dimensions dragged in the browser, and at once what they do."""
