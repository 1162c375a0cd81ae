"""Spectra of a scene file, as Mitsuba 3 takes them.

A reflectance or emittance is given by name or by control points, with straight lines between them and level
ends. Emittances are scaled to Y = 1 with the tables of `renderer/data`.
"""

import csv
import math
from pathlib import Path

DATA = Path(__file__).resolve().parents[2] / "data"
MIN_NM, MAX_NM = 360.0, 830.0
# Mitsuba divides by this integral of its own y-bar table (include/mitsuba/core/spectrum.h,
# MI_CIE_Y_NORMALIZATION); ours is the sum over the table at 1 nm.
MITSUBA_INTEGRAL_OF_Y = 106.7502593994140625
PLANCK_C2_NM_K = 1.438776877e7


def table(name):
    """The columns of a table of `renderer/data`, by name."""
    with open(DATA / name, newline="") as lines:
        rows = list(csv.reader(line for line in lines if not line.startswith("#")))
    columns = zip(*[[float(value) for value in row] for row in rows[1:]])
    return dict(zip(rows[0], columns))


CIE = table("cie_1931_2deg.csv")
SUM_OF_Y = sum(CIE["y_bar"])


def at(points, nm):
    """The value of control points at a wavelength."""
    if nm <= points[0][0]:
        return points[0][1]
    for (nm0, value0), (nm1, value1) in zip(points, points[1:]):
        if nm < nm1:
            return value0 + (nm - nm0) / (nm1 - nm0) * (value1 - value0)
    return points[-1][1]


def reflectance(value, named):
    """The control points of a reflectance; `named` is the table [reflectances] of the scene."""
    if not isinstance(value, str):
        return [tuple(point) for point in value]
    if value in named:
        return reflectance(named[value], {})
    patches = table("colorchecker_ohta_1997.csv")
    for name, column in patches.items():
        if f"colorchecker {name.split(' (')[0]}" == value:
            return list(zip(patches["wavelength_nm"], column))
    raise ValueError(f"no reflectance is called {value!r}")


def emittance(value):
    """The control points of an emittance, scaled to Y = 1."""
    if not isinstance(value, str):
        points = [tuple(point) for point in value]
    elif value == "E":
        points = [(560.0, 1.0)]
    elif value in ("D65", "A"):
        illuminants = table("cie_illuminants.csv")
        points = list(zip(illuminants["wavelength_nm"], illuminants[value.lower()]))
    elif value.startswith("blackbody ") and value.endswith(" K"):
        kelvin = float(value[10:-2])
        nms = [float(nm) for nm in range(360, 831)]
        points = [(nm, (nm / 560) ** -5 / math.expm1(PLANCK_C2_NM_K / (nm * kelvin))) for nm in nms]
    else:
        raise ValueError(f"no light is called {value!r}")
    y = sum(at(points, nm) * y_bar for nm, y_bar in zip(CIE["wavelength_nm"], CIE["y_bar"]))
    return [(nm, power * SUM_OF_Y / y) for nm, power in points]


def xml(name, points, factor=1.0):
    """A spectrum as a Mitsuba element called `name`: `irregular`, made level beyond its ends."""
    points = list(points)
    if points[0][0] > MIN_NM - 10:
        points.insert(0, (MIN_NM - 10, points[0][1]))
    if points[-1][0] < MAX_NM + 10:
        points.append((MAX_NM + 10, points[-1][1]))
    nms = ", ".join(f"{nm:.9g}" for nm, _ in points)
    values = ", ".join(f"{factor * value:.9g}" for _, value in points)
    return (
        f'<spectrum type="irregular" name="{name}"><string name="wavelengths" value="{nms}"/>'
        f'<string name="values" value="{values}"/></spectrum>'
    )
