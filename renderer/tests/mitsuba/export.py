"""Writes a scene of Acuity as Mitsuba 3 XML.

    python export.py SCENE.toml OUT.xml [--size 320x320] [--samples 64] [--lights 0,2]

or, from another script, `Exported(scene_file, mesh_folder).xml(size_px, samples)`. Geometry, reflectances and
emittances are exact in Mitsuba's single precision; a cone, a patterned disc and a thin cylinder are many narrow
triangles, written as PLY beside the XML. What plain Mitsuba has no counterpart for is listed in `Exported.notes` and
printed: ambient light that nothing blocks, Phong highlights of lights that have no extent, and the clear coat
(written as `plastic`). With `exact=True` these are there too; the XML then needs the plugins of `whitted.py`.

Units. Ours: illuminance 1 makes a perfect white diffuser Y = 1. Mitsuba's: watts. A perfect diffuser under
the irradiance E sends E/pi, so illuminances are multiplied by pi; the constant by which Mitsuba's XYZ differ is
taken out too. So the XYZ of a Mitsuba film are ours.

Lights are numbered in the order distant, point, rectangle, sphere.
"""

import argparse
import math
import sys
import tomllib
from pathlib import Path
from xml.sax.saxutils import escape

import spectra
from geometry import Frame, add, cross, difference, fan, length, matrix, scaled, tube, unit, write_triangles

RADIANCE = spectra.MITSUBA_INTEGRAL_OF_Y / spectra.SUM_OF_Y
POWER = math.pi * RADIANCE
# The endless ground becomes a square of this half size about the camera.
GROUND_HALF_M = 60.0
# Mitsuba solves for a cylinder in units of its radius; in single precision a thin one far away is lost (at
# 8 m and a radius of 4 mm the sought difference of squares is 1 of 4 million). Thinner ones become triangles.
THINNEST_CYLINDER_M = 0.05


class Exported:
    """A scene as pieces of XML: shapes, materials, lights."""

    def __init__(self, scene_file, mesh_folder=None, exact=False):
        self.path = Path(scene_file)
        self.scene = tomllib.loads(self.path.read_text())
        self.mesh_folder = Path(mesh_folder) if mesh_folder else self.path.parent
        self.exact = exact
        self.notes = []
        self.materials = {}
        for kind in ("diffuse", "glossy", "mirror", "glass"):
            for name, material in self.scene.get(kind, {}).items():
                self.materials[name] = (kind, material)
        self.note_what_has_no_counterpart()

    def note_what_has_no_counterpart(self):
        known = {"camera", "ambient", "distant_light", "point_light", "reflectances", "diffuse", "glossy"}
        known |= {"mirror", "glass", "sphere", "box", "cylinder", "cone", "disc", "rectangle", "ground"}
        known |= {"rectangle_light", "sphere_light", "mesh"}
        for key in self.scene.keys() - known:
            raise ValueError(f"{self.path}: the table {key} cannot be exported")
        if self.exact:
            return
        if "ambient" in self.scene:
            self.notes.append("ambient light is left out: Mitsuba has none that nothing blocks")
        for name, (kind, material) in self.materials.items():
            if material.get("highlight", 0) > 0:
                self.notes.append(f"{name}: its highlight is left out: Mitsuba's phong has another cosine")
            if kind == "glossy" and "refractive_index" in material:
                self.notes.append(f"{name}: its clear coat is Mitsuba's plastic, whose body is darker")

    def reflectance(self, name, value):
        return spectra.xml(name, spectra.reflectance(value, self.scene.get("reflectances", {})))

    def lights(self, kept):
        """The elements of the lights of the numbers `kept`; other areas are there and dark."""
        found = self.lights_without_extent()
        found = [light for number, light in enumerate(found) if number in kept]
        number = len(self.lights_without_extent())
        black = '<bsdf type="diffuse"><spectrum name="reflectance" value="0"/></bsdf>'
        for kind in ("rectangle_light", "sphere_light"):
            for light in self.scene.get(kind, []):
                radiance = spectra.xml("radiance", spectra.emittance(light["emittance"]), RADIANCE * light["luminance"])
                shines = f'<emitter type="area">{radiance}</emitter>' if number in kept else ""
                if kind == "rectangle_light":
                    u, v = light["edge_u_m"], light["edge_v_m"]
                    columns = rectangle_columns(light["corner_m"], u, v)
                    found.append(shape("rectangle", columns, black + shines))
                else:
                    place = point("center", light["center_m"]) + number_of("radius", light["radius_m"])
                    found.append(f'<shape type="sphere">{place}{black}{shines}</shape>')
                number += 1
        return found

    def light_count(self):
        kinds = ("distant_light", "point_light", "rectangle_light", "sphere_light")
        return sum(len(self.scene.get(kind, [])) for kind in kinds)

    def lights_without_extent(self):
        found = []
        for light in self.scene.get("distant_light", []):
            direction = scaled(unit(light["from"]), -1)
            power = spectra.xml("irradiance", spectra.emittance(light["emittance"]), POWER * light["illuminance"])
            found.append(f'<emitter type="directional">{vector("direction", direction)}{power}</emitter>')
        for light in self.scene.get("point_light", []):
            power = spectra.xml("intensity", spectra.emittance(light["emittance"]), POWER * light["intensity"])
            found.append(f'<emitter type="point">{point("position", light["position_m"])}{power}</emitter>')
        return found

    def body(self, material, to_uv, name="reflectance"):
        """The reflectance of a body; `to_uv` takes a size to the scale and offset of Mitsuba's u and v."""
        if "checker" in material:
            pattern, across = material["checker"], "uv"
        elif "stripes" in material:
            pattern, across = material["stripes"], material["stripes"]["across"]
        else:
            return self.reflectance(name, material["reflectance"])
        # Mitsuba's checkerboard has its period at 1: two of our squares.
        (scale_u, start_u), (scale_v, start_v) = to_uv(2 * pattern["size_m"])
        if "u" not in across:
            scale_u, start_u = 0, 0.25
        if "v" not in across:
            scale_v, start_v = 0, 0.25
        place = [scale_u, 0, 0, start_u, 0, scale_v, 0, start_v, 0, 0, 1, 0, 0, 0, 0, 1]
        return (
            f'<texture type="checkerboard" name="{name}">'
            + self.reflectance("color0", material["reflectance"])
            + self.reflectance("color1", pattern["reflectance"])
            + f'<transform name="to_uv">{matrix(place)}</transform></texture>'
        )

    def gloss(self, kind, material, to_uv):
        """A surface with a highlight or a coat, as the plugin of `whitted.py`."""
        if kind == "mirror":
            inner = self.reflectance("metal", material["reflectance"])
        else:
            inner = self.body(material, to_uv, "body")
        for key in ("refractive_index", "highlight", "exponent"):
            if key in material:
                inner += number_of(key, float(material[key]))
        return f'<bsdf type="acuity_gloss">{inner}</bsdf>'

    def bsdf(self, name, to_uv):
        kind, material = self.materials[name]
        if kind == "glass":
            index = number_of("int_ior", material["refractive_index"]) + number_of("ext_ior", 1)
            return f'<bsdf type="dielectric">{index}</bsdf>'
        if self.exact and (kind == "glossy" or "highlight" in material):
            inner = self.gloss(kind, material, to_uv)
        elif kind == "mirror":
            mirror = self.reflectance("specular_reflectance", material["reflectance"])
            inner = f'<bsdf type="conductor"><string name="material" value="none"/>{mirror}</bsdf>'
        elif "refractive_index" in material:
            body = self.body(material, to_uv, "diffuse_reflectance")
            index = number_of("int_ior", material["refractive_index"]) + number_of("ext_ior", 1)
            inner = f'<bsdf type="plastic">{index}{body}</bsdf>'
        else:
            inner = f'<bsdf type="diffuse">{self.body(material, to_uv)}</bsdf>'
        return f'<bsdf type="twosided">{inner}</bsdf>'

    def is_patterned(self, name):
        material = self.materials[name][1]
        return "checker" in material or "stripes" in material

    def rectangle(self, name, corner, edges, start_m=(0, 0), flip=False):
        """A rectangle; the surface coordinates at its corner are `start_m`; `flip` turns its front round."""

        def to_uv(period_m):
            sides = zip(map(length, edges), start_m)
            return [(side / period_m, start / period_m) for side, start in sides]

        u, v, normal, middle = rectangle_columns(corner, *edges)
        columns = (u, v, scaled(normal, -1) if flip else normal, middle)
        return shape("rectangle", columns, self.bsdf(name, to_uv))

    def box(self, box):
        turn = math.radians(box.get("rotation_deg", 0))
        axes = [(math.cos(turn), math.sin(turn), 0), (-math.sin(turn), math.cos(turn), 0), (0, 0, 1)]
        edges = [scaled(axis, size) for axis, size in zip(axes, box["size_m"])]
        low = difference(box["center_m"], scaled(add(add(*edges[:2]), edges[2]), 0.5))
        for across in range(3):
            u, v = [edges[axis] for axis in range(3) if axis != across]
            # Glass must face outwards; x cross z is against y.
            for is_high, corner in enumerate((low, add(low, edges[across]))):
                flip = (is_high == 1) == (across == 1)
                yield self.rectangle(box["material"], corner, (u, v), flip=flip)

    def sphere(self, sphere):
        radius = sphere["radius_m"]

        def to_uv(period_m):
            # Mitsuba: u = angle / 2 pi from 0, v = angle from the pole / pi. The sphere is turned by half
            # a turn, so that both seams lie on the same side.
            around = 2 * math.pi * radius / period_m
            return [(around, -around / 2), (-around / 2, around / 4)]

        columns = ((-radius, 0, 0), (0, -radius, 0), (0, 0, radius), sphere["center_m"])
        return shape("sphere", columns, self.bsdf(sphere["material"], to_uv))

    def disc(self, name, center, frame, radius, label, flip=False):
        if not self.is_patterned(name):
            axis = scaled(frame.axis, -1) if flip else frame.axis
            columns = (scaled(frame.across, radius), scaled(frame.along, radius), axis, center)
            return shape("disk", columns, self.bsdf(name, None))
        apex = (center, lambda angle: (0.0, 0.0))
        rim = lambda angle: (radius * math.cos(angle), radius * math.sin(angle))
        return self.triangles(name, fan(apex, (center, frame, radius, rim)), label)

    def triangles(self, name, corners, label):
        file = self.mesh_folder / f"{self.path.stem}-{label}.ply"
        write_triangles(file, corners)
        bsdf = self.bsdf(name, lambda period_m: [(1 / period_m, 0), (1 / period_m, 0)])
        filename = f'<string name="filename" value="{escape(str(file.resolve()))}"/>'
        return f'<shape type="ply">{filename}<boolean name="face_normals" value="true"/>{bsdf}</shape>'

    def cylinder(self, cylinder, label):
        base, top, radius = cylinder["base_m"], cylinder["top_m"], cylinder["radius_m"]
        name = cylinder["material"]
        frame = Frame.about(unit(difference(top, base)))
        height = length(difference(top, base))

        def to_uv(period_m):
            around = 2 * math.pi * radius / period_m
            return [(around, -around / 2), (height / period_m, 0)]

        if radius < THINNEST_CYLINDER_M:
            yield self.triangles(name, tube(base, top, frame, radius), f"{label}-side")
        else:
            columns = (scaled(frame.across, -radius), scaled(frame.along, -radius), scaled(frame.axis, height), base)
            yield shape("cylinder", columns, self.bsdf(name, to_uv))
        yield self.disc(name, base, frame, radius, f"{label}-base", flip=True)
        yield self.disc(name, top, frame, radius, f"{label}-top")

    def cone(self, cone, label):
        base, apex, radius = cone["base_m"], cone["apex_m"], cone["radius_m"]
        frame = Frame.about(unit(difference(apex, base)))
        slope = math.hypot(length(difference(apex, base)), radius)
        tip = (apex, lambda angle: (radius * angle, slope))
        rim = (base, frame, radius, lambda angle: (radius * angle, 0.0))
        yield self.triangles(cone["material"], fan(tip, rim), f"{label}-side")
        yield self.disc(cone["material"], base, frame, radius, f"{label}-base", flip=True)

    def mesh(self, mesh):
        """A mesh of PLY or OBJ whose file has z up, with a material of the scene."""
        file = self.path.parent / mesh["file"]
        if mesh.get("up") != "z" or "material" not in mesh or file.suffix not in (".ply", ".obj"):
            raise ValueError(f"{self.path}: {file.name}: only PLY and OBJ with up = \"z\" and a material")
        turn, scale = math.radians(mesh.get("rotation_deg", 0)), mesh.get("scale", 1)
        cos, sin = scale * math.cos(turn), scale * math.sin(turn)
        columns = ((cos, sin, 0), (-sin, cos, 0), (0, 0, scale), mesh.get("position_m", (0, 0, 0)))
        normals = b"property float nx" if file.suffix == ".ply" else b"\nvn "
        is_flat = str(normals not in file.read_bytes()).lower()
        filename = f'<string name="filename" value="{escape(str(file.resolve()))}"/>'
        flat = f'<boolean name="face_normals" value="{is_flat}"/>'
        return shape(file.suffix[1:], columns, filename + flat + self.bsdf(mesh["material"], None))

    def shapes(self):
        """The elements of all shapes."""
        scene, half = self.scene, GROUND_HALF_M
        for ground in scene.get("ground", []):
            x, y, _ = scene["camera"]["position_m"]
            corner = (x - half, y - half, ground["height_m"])
            edges = ((2 * half, 0, 0), (0, 2 * half, 0))
            yield self.rectangle(ground["material"], corner, edges, corner[:2])
        for mesh in scene.get("mesh", []):
            yield self.mesh(mesh)
        for rectangle in scene.get("rectangle", []):
            edges = (rectangle["edge_u_m"], rectangle["edge_v_m"])
            yield self.rectangle(rectangle["material"], rectangle["corner_m"], edges)
        for box in scene.get("box", []):
            yield from self.box(box)
        for sphere in scene.get("sphere", []):
            yield self.sphere(sphere)
        for index, disc in enumerate(scene.get("disc", [])):
            frame = Frame.about(unit(disc["normal"]))
            yield self.disc(disc["material"], disc["center_m"], frame, disc["radius_m"], f"disc-{index}")
        for index, cylinder in enumerate(scene.get("cylinder", [])):
            yield from self.cylinder(cylinder, f"cylinder-{index}")
        for index, cone in enumerate(scene.get("cone", [])):
            yield from self.cone(cone, f"cone-{index}")

    def sensor(self, size_px, samples):
        camera = self.scene["camera"]
        places = [" ".join(map(str, camera[key])) for key in ("position_m", "look_at_m", "up")]
        look = '<lookat origin="{}" target="{}" up="{}"/>'.format(*[p.replace(" ", ", ") for p in places])
        width, height = size_px
        return (
            f'<sensor type="perspective"><string name="fov_axis" value="y"/>'
            f'{number_of("fov", camera["vertical_field_of_view_deg"])}'
            f'<transform name="to_world">{look}</transform>'
            f'<sampler type="independent"><integer name="sample_count" value="{samples}"/></sampler>'
            f'<film type="hdrfilm"><integer name="width" value="{width}"/><integer name="height" value="{height}"/>'
            '<string name="pixel_format" value="xyz"/><string name="component_format" value="float32"/>'
            '<rfilter type="tent"/></film></sensor>'
        )

    def ambient(self):
        if "ambient" not in self.scene:
            return ""
        ambient = self.scene["ambient"]
        return spectra.xml("ambient", spectra.emittance(ambient["emittance"]), RADIANCE * ambient["illuminance"])

    def xml(self, size_px=(320, 320), samples=64, lights=None, integrator=None):
        """The whole scene; `lights` are the numbers of those to keep, all of them if not said."""
        kept = range(self.light_count()) if lights is None else lights
        if self.exact:
            integrator = f'<integrator type="whitted">{self.ambient()}</integrator>'
        elif integrator is None:
            integrator = '<integrator type="path"><integer name="max_depth" value="6"/></integrator>'
        parts = [integrator, self.sensor(size_px, samples), *self.lights(kept), *self.shapes()]
        return '<?xml version="1.0"?>\n<scene version="3.0.0">\n' + "\n".join(parts) + "\n</scene>\n"


def rectangle_columns(corner, u, v):
    """What takes Mitsuba's square from -1 to 1 to a rectangle."""
    middle = add(corner, scaled(add(u, v), 0.5))
    return (scaled(u, 0.5), scaled(v, 0.5), unit(cross(u, v)), middle)


def number_of(name, value):
    return f'<float name="{name}" value="{value}"/>'


def point(name, place):
    return '<point name="{}" x="{}" y="{}" z="{}"/>'.format(name, *place)


def vector(name, direction):
    return '<vector name="{}" x="{}" y="{}" z="{}"/>'.format(name, *direction)


def shape(kind, columns, bsdf):
    """A shape of Mitsuba whose own axes and origin are taken to `columns`."""
    rows = [entry for row in zip(*columns) for entry in row] + [0, 0, 0, 1]
    return f'<shape type="{kind}"><transform name="to_world">{matrix(rows)}</transform>{bsdf}</shape>'


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("out")
    parser.add_argument("--size", default="320x320")
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--lights", help="numbers of the lights to keep, such as 0,2")
    arguments = parser.parse_args()
    exported = Exported(arguments.scene, Path(arguments.out).resolve().parent)
    lights = arguments.lights and [int(light) for light in arguments.lights.split(",")]
    size_px = [int(size) for size in arguments.size.split("x")]
    Path(arguments.out).write_text(exported.xml(size_px, arguments.samples, lights))
    for note in exported.notes:
        print(f"note: {note}", file=sys.stderr)


if __name__ == "__main__":
    main()
