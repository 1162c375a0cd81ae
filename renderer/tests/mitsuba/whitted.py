"""What Acuity follows and no more, as plugins of Mitsuba 3: an integrator and a glossy surface.

`path` lets diffuse surfaces light each other, which Acuity leaves out; `whitted` takes direct light of every
emitter at each hit and then follows mirrored and refracted rays only. `acuity_gloss` is a body under a clear
coat, or a metal, with Phong's highlight without a cosine. Geometry, lights, spectra, patterns and film remain
Mitsuba's own. Only for the variant `llvm_ad_spectral`; import it after the variant is set.
"""

import drjit as dr
import mitsuba as mi


class Whitted(mi.SamplingIntegrator):
    def __init__(self, props):
        super().__init__(props)
        self.max_hits = props.get("max_hits", 8)
        # The reflected light of a white surface that faces up, if nothing blocks it.
        self.ambient = props.get("ambient") if "ambient" in props else None

    def sample(self, scene, sampler, ray, medium=None, active=True):
        context = mi.BSDFContext()
        ray, active = mi.Ray3f(ray), mi.Bool(active)
        found, share = mi.Spectrum(0), mi.Spectrum(1)
        first_hit = mi.Bool(False)
        for hit in range(self.max_hits):
            surface = scene.ray_intersect(ray, active)
            found += dr.select(active, share * surface.emitter(scene).eval(surface, active), 0)
            active &= surface.is_valid()
            first_hit = active if hit == 0 else first_hit
            bsdf = surface.bsdf(ray)
            for emitter in scene.emitters():
                at_light, power = emitter.sample_direction(surface, sampler.next_2d(active), active)
                lit = active & (at_light.pdf > 0)
                lit &= ~scene.ray_test(surface.spawn_ray_to(at_light.p), lit)
                scattered = bsdf.eval(context, surface, surface.to_local(at_light.d), lit)
                found += dr.select(lit, share * scattered * power, 0)
            if self.ambient is not None:
                up = dr.select(surface.wi.z < 0, -surface.sh_frame.n.z, surface.sh_frame.n.z)
                body = bsdf.eval_diffuse_reflectance(surface, active)
                found += dr.select(active, share * body * self.ambient.eval(surface, active) * 0.5 * (1 + up), 0)
            sent_on, weight = bsdf.sample(context, surface, sampler.next_1d(active), sampler.next_2d(active), active)
            active &= mi.has_flag(sent_on.sampled_type, mi.BSDFFlags.Delta)
            share = dr.select(active, share * weight, share)
            ray = surface.spawn_ray(surface.to_world(sent_on.wo))
        return found, first_hit, []


class Gloss(mi.BSDF):
    def __init__(self, props):
        super().__init__(props)
        self.body = props.get("body") if "body" in props else None
        self.metal = props.get("metal") if "metal" in props else None
        self.index = props.get("refractive_index", 0.0)
        self.highlight, self.exponent = props.get("highlight", 0.0), props.get("exponent", 1.0)
        flags = mi.BSDFFlags.FrontSide
        self.m_components = [mi.BSDFFlags.DiffuseReflection | flags, mi.BSDFFlags.DeltaReflection | flags]
        self.m_flags = self.m_components[0] | self.m_components[1]

    def coat(self, surface):
        """What part of the light the coat mirrors."""
        if self.index == 0:
            return mi.Float(0)
        return mi.fresnel(mi.Frame3f.cos_theta(surface.wi), self.index)[0]

    def sample(self, context, surface, sample1, sample2, active=True):
        bs = dr.zeros(mi.BSDFSample3f)
        bs.wo = mi.reflect(surface.wi)
        bs.pdf, bs.eta = 1.0, 1.0
        bs.sampled_component = 1
        is_mirror = self.metal is not None or self.index != 0
        bs.sampled_type = mi.UInt32(+(mi.BSDFFlags.DeltaReflection if is_mirror else mi.BSDFFlags.Null))
        active = active & (mi.Frame3f.cos_theta(surface.wi) > 0)
        share = self.metal.eval(surface, active) if self.metal is not None else mi.Spectrum(self.coat(surface))
        return bs, dr.select(active, share, 0)

    def eval(self, context, surface, wo, active=True):
        cos_wi, cos_wo = mi.Frame3f.cos_theta(surface.wi), mi.Frame3f.cos_theta(wo)
        value = self.eval_diffuse_reflectance(surface, active) * cos_wo
        cos_alpha = dr.maximum(dr.dot(mi.reflect(surface.wi), wo), 0)
        value += self.highlight * dr.power(cos_alpha, self.exponent)
        return dr.select(active & (cos_wi > 0) & (cos_wo > 0), value / dr.pi, 0)

    def eval_diffuse_reflectance(self, surface, active=True):
        if self.body is None:
            return mi.Spectrum(0)
        return self.body.eval(surface, active) * (1 - self.coat(surface))

    def pdf(self, context, surface, wo, active=True):
        return mi.Float(0)

    def eval_pdf(self, context, surface, wo, active=True):
        return self.eval(context, surface, wo, active), mi.Float(0)

    def to_string(self):
        return "acuity_gloss"


mi.register_integrator("whitted", Whitted)
mi.register_bsdf("acuity_gloss", Gloss)
