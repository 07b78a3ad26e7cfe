"""The numbers that decide: each documented, none with a dimension, all of them in a result."""

import ast
import itertools
import math
from pathlib import Path

from stochfric_mb.discovery import criteria


def test_every_criterion_says_what_it_is_and_has_no_dimension():
    body = ast.parse(Path(criteria.__file__).read_text()).body
    named = set()
    for node, after in itertools.pairwise(body):
        if isinstance(node, ast.Assign):
            assert isinstance(after, ast.Expr), ast.unparse(node)
            reason = ast.literal_eval(after.value)
            assert not any(unit in reason for unit in ("[m]", "[s]", "[N]", "[Hz]", "[kg]", "[N s]")), reason
            targets = node.targets[0]
            named |= {e.id for e in targets.elts} if isinstance(targets, ast.Tuple) else {targets.id}
    assert {name.lower() for name in named} == set(criteria.values())
    assert all(math.isfinite(value) for value in criteria.values().values())
