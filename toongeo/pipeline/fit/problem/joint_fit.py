"""Several pictures of one person, fitted with one identity."""

from __future__ import annotations

from collections.abc import Sequence

from toongeo.pipeline.fit.losses.joint_loss import JointLoss
from toongeo.pipeline.fit.losses.minimized import minimized
from toongeo.pipeline.fit.problem.landmark_problem import LandmarkProblem
from toongeo.pipeline.fit.problem.solution import Solution

__all__ = ["joint_fit"]


def joint_fit(problems: Sequence[LandmarkProblem], algorithm: str) -> list[Solution]:
    """Solutions with one identity for problems with the same model and options.

    The passes are those of `LandmarkProblem.solve`, in step: all pictures are minimised as one, and then the jaw
    points and the robust weights of each are renewed. Status, passes and evaluations are those of all.
    """
    if len(problems) == 1:
        return [problems[0].solve(algorithm)]
    options = problems[0].options
    states = [problem.first_state(problem.search.start) for problem in problems]
    parts = [problem.search.start for problem in problems]
    passes = evaluations = 0
    while passes < options.solver.max_passes:
        loss = JointLoss(
            [
                problem.loss(placed.vertices, placed.prior_weight, placed.robust_weight)
                for problem, placed in zip(problems, states, strict=True)
            ]
        )
        bounds = (
            loss.joined([problem.search.bounds[0] for problem in problems]),
            loss.joined([placed.upper for placed in states]),
        )
        minimum = minimized(loss, loss.joined(parts), bounds, algorithm, options.solver)
        parts = [loss.part(minimum.x, k) for k in range(len(problems))]
        passes, evaluations = passes + 1, evaluations + minimum.evaluations
        before, asked = states, problems
        told = [problem.told(placed, part) for problem, placed, part in zip(problems, before, parts, strict=True)]
        problems, parts = [problem for problem, _ in told], [part for _, part in told]
        states = [
            problem.renewed(placed, part, first=passes == 1)
            for problem, placed, part in zip(problems, before, parts, strict=True)
        ]
        stayed = all(new.target.convention == old.target.convention for new, old in zip(problems, asked, strict=True))
        if stayed and all(p.settled(*pair) for p, *pair in zip(problems, before, states, strict=True)):
            break
    return [
        problem.solution(part, placed, after, minimum.status, passes, evaluations)
        for problem, part, placed, after in zip(problems, parts, before, states, strict=True)
    ]
