"""A mission in pictures: `over_time`, `from_above`, two `side_by_side`; `output` makes files and parts of pages."""
