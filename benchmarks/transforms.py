# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole surfaces against the bare transforms that a naive synthesis would need, one for each field."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from .field_sets import ALL, SIX, THREE, FieldSet, surface_maker
from .measure import Timings, interleaved
from .plan import Plan
from .rows import Row, ratio_row

GROUP = "transforms"


def rows(plan: Plan) -> Iterator[Row]:
    """Three, six and all fields at every size, with one and two workers."""
    for resolution in plan.sizes:
        for fields in (THREE, SIX, ALL):
            yield from _compare(plan, resolution, fields)
            gc.collect()  # the arrays of one comparison are gone before those of the next


def _compare(plan: Plan, resolution: int, fields: FieldSet) -> Iterator[Row]:
    sides = {
        "one worker": surface_maker(fields, resolution, 1),
        "two workers": surface_maker(fields, resolution, 2),
        "numpy": numpy_transforms(fields.transforms, resolution),
        "fftw": planned_transforms(fields.transforms, resolution, plan.plan_transforms),
        "probe": two_transforms_at_once(resolution),
    }
    timings = interleaved(sides, plan.rounds)
    name = f"{fields.name}, {resolution}²"
    yield ratio_row(
        GROUP, f"{name}, one worker against {fields.transforms} irfft2", timings, "one worker", "numpy",
        target=_target(fields, resolution, plan),
    )  # fmt: skip
    yield ratio_row(
        GROUP, f"{name}, one worker against {fields.transforms} planned FFTW", timings, "one worker", "fftw"
    )
    yield ratio_row(
        GROUP, f"{name}, two workers against one", timings, "two workers", "one worker", faster=True,
        free_cores=free_cores(timings, fields.transforms),
        target="two workers" if resolution >= 1024 or plan.smoke else None,
    )  # fmt: skip


def _target(fields: FieldSet, resolution: int, plan: Plan) -> str | None:
    if fields is THREE:
        return "3 fields" if resolution >= 512 or plan.smoke else None
    if fields is SIX and (resolution >= 2048 or (plan.smoke and resolution == plan.sizes[-1])):
        return "6 fields, large"
    if fields is SIX and (resolution == 1024 or plan.smoke):
        return "6 fields"
    return None


def free_cores(timings: Timings, transforms: int = 1) -> float:
    """How many cores two transforms at once had, of the sides "numpy" and "probe"."""
    return 2.0 * timings.ratio("numpy", "probe") / transforms


def numpy_transforms(count: int, resolution: int) -> Callable[[], None]:
    """`numpy.fft.irfft2` of so many complex64 inputs, into arrays that are there already."""
    pairs = [_pair(resolution, seed) for seed in range(count)]

    def run() -> None:
        for coefficients, out in pairs:
            np.fft.irfft2(coefficients, out=out)

    return run


def two_transforms_at_once(resolution: int) -> Callable[[], None]:
    """The same transform on each of two threads."""
    pairs = [_pair(resolution, seed) for seed in range(2)]
    pool = ThreadPoolExecutor(2)

    def run() -> None:
        for done in [pool.submit(np.fft.irfft2, coefficients, out=out) for coefficients, out in pairs]:
            done.result()

    return run


def planned_transforms(count: int, resolution: int, measured: bool) -> Callable[[], None]:
    """As many transforms by FFTW, planned beforehand: what no synthesis of separate fields can beat."""
    import pyfftw

    coefficients = pyfftw.empty_aligned((resolution, resolution // 2 + 1), "complex64")
    out = pyfftw.empty_aligned((resolution, resolution), "float32")
    flags = ("FFTW_MEASURE" if measured else "FFTW_ESTIMATE", "FFTW_DESTROY_INPUT")
    plan = pyfftw.FFTW(coefficients, out, axes=(0, 1), direction="FFTW_BACKWARD", flags=flags, threads=1)
    coefficients[...] = 0.0  # FFTW leaves its workings there: of zeros nothing grows from run to run

    def run() -> None:
        for _ in range(count):
            plan.execute()

    return run


def _pair(resolution: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(seed)
    coefficients = np.empty((resolution, resolution // 2 + 1), np.complex64)
    coefficients.real = random.standard_normal(coefficients.shape, np.float32)
    coefficients.imag = random.standard_normal(coefficients.shape, np.float32)
    return coefficients, np.full((resolution, resolution), 1.0, np.float32)
