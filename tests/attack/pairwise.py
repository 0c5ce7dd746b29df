"""A sample of all combinations in which each two values of different factors meet at least once."""

import itertools


def _pairs(row):
    """Those that meet in a row, which may still lack factors: sets of two (factor, value)."""
    return {frozenset(pair) for pair in itertools.combinations(row.items(), 2)}


def pairwise(factors):
    """Rows {factor: value}; `factors` has the values of each. Greedy: each row begins with a pair that has not met yet,
    and takes of each other factor the value that lets the most new pairs meet."""
    open_pairs = {frozenset(((one, a), (other, b))): None  # a set in order: the same factors give the same rows
                  for one, other in itertools.combinations(factors, 2)
                  for a in factors[one] for b in factors[other]}
    rows = []
    while open_pairs:
        row = dict(next(iter(open_pairs)))
        for factor in factors:
            if factor not in row:
                row[factor] = max(factors[factor], key=lambda value: _gain(row, factor, value, open_pairs))
        for pair in _pairs(row):
            open_pairs.pop(pair, None)
        rows.append({factor: row[factor] for factor in factors})
    return rows


def _gain(row, factor, value, open_pairs):
    return sum(frozenset((known, (factor, value))) in open_pairs for known in row.items())
