"""A second, slow statics: triangles solved by the law of cosines, joint rates by differences, no code of the package.

Only a design's numbers and the moments' samples are read.
"""

import math
from typing import Any

import numpy as np

POINTS = 100_000  # errors fall as 1/POINTS; here at most 1e-4 of the work


def turn(design: Any) -> dict[str, Any]:
    """Knee and hip over a turn, rad, and the least distance from a dead centre, m: negative if it does not close."""
    linkage, rider = design.linkage, design.rider
    theta = np.linspace(0, 2 * np.pi, POINTS + 1)
    centre = linkage.ground + (linkage.pivot_to_crank if linkage.kind != "trt" else 0)
    pin = np.stack([centre.real + linkage.crank * np.cos(theta), centre.imag + linkage.crank * np.sin(theta)])
    margins, pedal = [], pin
    if linkage.kind != "trt":
        pivot = np.array([[linkage.ground.real], [linkage.ground.imag]])
        side = 1 if linkage.branch == "left" else -1
        joint, margin = triangle(pivot, pin, linkage.rocker, linkage.coupler, side)
        margins.append(margin)
        if linkage.kind == "crt":
            pedal = joint + (joint - pivot) / linkage.rocker * linkage.pedal_arm
        else:
            along = (pin - joint) / linkage.coupler
            cos, sin = math.cos(linkage.coupler_angle), math.sin(linkage.coupler_angle)
            pedal = joint + linkage.pedal_arm * np.stack(
                [cos * along[0] - sin * along[1], sin * along[0] + cos * along[1]]
            )
    shank = math.sqrt(rider.shank**2 + linkage.foot**2)
    knee, margin = triangle(np.zeros((2, 1)), pedal, rider.thigh, shank, -1)
    margins.append(margin)
    with np.errstate(invalid="ignore"):
        cosine = (rider.thigh**2 + shank**2 - (pedal**2).sum(axis=0)) / (2 * rider.thigh * shank)
        inside = np.arccos(np.clip(cosine, -1, 1))
    return {
        "knee": inside - math.atan2(linkage.foot, rider.shank),
        "hip": np.unwrap(np.arctan2(knee[1], knee[0])) - linkage.seat_angle,
        "margin": min(margins),
    }


def triangle(start: Any, end: Any, first: float, second: float, side: int) -> tuple[Any, float]:
    """Third corner, shape (2, n), on the left (1) or right (-1) of start -> end; least distance from a dead centre."""
    across = end - start
    span = np.sqrt((across**2).sum(axis=0))
    margin = min(first + second - span.max(), span.min() - abs(first - second))
    with np.errstate(invalid="ignore"):
        angle = np.arctan2(across[1], across[0]) + side * np.arccos(
            (first**2 + span**2 - second**2) / (2 * first * span)
        )
    return start + first * np.stack([np.cos(angle), np.sin(angle)]), float(margin)


def mean_power(design: Any, moments: Any, motion: dict[str, Any]) -> tuple[float, float, bool]:
    """Mean power of one leg, W; the same of all work counted positive; whether both joints enter the moments' range."""
    measured = turn(moments.measured_on.design)
    theta = np.linspace(0, 2 * np.pi, POINTS + 1)
    centre = moments.measured_on.design.linkage.ground
    from_top = theta - math.atan2(-centre.imag, -centre.real)
    net, gross, enters = 0.0, 0.0, True
    for joint, samples in (("knee", moments.knee), ("hip", moments.hip)):
        known = np.interp(from_top, moments.crank_angle, samples, period=2 * np.pi)
        branches = {}
        low, high = measured[joint].min(), measured[joint].max()
        for sign in (1, -1):
            rows = sign * np.gradient(measured[joint]) > 0
            order = np.argsort(measured[joint][rows])
            branches[sign] = measured[joint][rows][order], known[rows][order]
        middle = (motion[joint][1:] + motion[joint][:-1]) / 2
        middle = middle - 2 * np.pi * np.round((middle - (low + high) / 2) / (2 * np.pi))
        enters &= bool(np.any((middle > low) & (middle < high)))
        step = np.diff(motion[joint])
        moment = np.where(step >= 0, np.interp(middle, *branches[1]), np.interp(middle, *branches[-1]))
        net, gross = net + float(moment @ step), gross + float(np.abs(moment * step).sum())
    cadence = 2 * design.linkage.gear_ratio * (5.71 / 3.6) / 0.66
    return net * cadence / (2 * np.pi), gross * cadence / (2 * np.pi), enters
