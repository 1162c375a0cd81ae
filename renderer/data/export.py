"""Writes the tables beside this file from colour-science 0.4.7 (`pip install colour-science==0.4.7`).

CIE data: CIE 1931 2 degree colour-matching functions, standard illuminants D65 and A, 360-830 nm at 1 nm.
Reflectances: the 24 patches of the ColorChecker, measured by N. Ohta (1997), 380-780 nm at 5 nm.
"""
from pathlib import Path
import colour

here = Path(__file__).parent
cmfs = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
PROGRAM = "colour-science 0.4.7"


def write(name, source, header, rows):
    lines = [f"# {source}", header]
    lines += [",".join(repr(float(v)) if i else f"{v:.0f}" for i, v in enumerate(row)) for row in rows]
    (here / name).write_text("\n".join(lines) + "\n")


write(
    "cie_1931_2deg.csv",
    f"CIE 1931 2 degree colour-matching functions, 1 nm, doi 10.25039/CIE.DS.xvudnb9b; as in {PROGRAM}, MSDS_CMFS",
    "wavelength_nm,x_bar,y_bar,z_bar",
    [(nm, *values) for nm, values in zip(cmfs.wavelengths, cmfs.values)],
)
d65, a = (colour.SDS_ILLUMINANTS[name].copy().align(cmfs.shape) for name in ("D65", "A"))
write(
    "cie_illuminants.csv",
    f"CIE standard illuminants D65 and A, 100 at 560 nm, as in {PROGRAM}, SDS_ILLUMINANTS (5 nm to 780 nm; its `align` to 1 nm)",
    "wavelength_nm,d65,a",
    zip(cmfs.wavelengths, d65.values, a.values),
)
patches = colour.SDS_COLOURCHECKERS["ColorChecker N Ohta"]
names = list(patches)
nms = patches[names[0]].wavelengths
write(
    "colorchecker_ohta_1997.csv",
    f"Reflectance of the 24 ColorChecker patches measured by N. Ohta (1997), 5 nm; as in {PROGRAM}, SDS_COLOURCHECKERS",
    ",".join(["wavelength_nm", *names]),
    [(nm, *(patches[n].values[i] for n in names)) for i, nm in enumerate(nms)],
)
