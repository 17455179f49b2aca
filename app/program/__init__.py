"""The document: what a program may say, and whether it says it consistently."""
