"""Which tools read the exported models, and how well."""
