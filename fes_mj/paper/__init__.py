"""The paper examined: its printed values, the identified dimensions and the recovered joint moments."""
