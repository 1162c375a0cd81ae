//! From a ray tree to the tristimulus value of one channel: section 3.3 of Meyer & Liu (1992), step 2.
//!
//! The light of one way is the sum over wavelengths of weight × power × reflectance × mirrors. For spectra
//! that the scene names this sum is a constant, computed once for each channel; a ray then costs a product
//! for each way by which light reaches it. A surface with a spectrum of its own is summed wavelength by
//! wavelength, only over the wavelengths that count for the channel.
//!
//! Tables by wavelength are filled up to a multiple of four with wavelengths of weight zero.

use protocols::{Channel, PerChannel};

use crate::ray_tree::{LightShare, LitSurface, RayTree};
use crate::scene::Scene;
use crate::scene::material::{Mirror, Reflectance, ReflectanceIndex};
use crate::spectra::{Sigmoid, WavelengthRule};
use crate::tints::{TintIndex, Tints};

/// Wavelengths that are computed side by side.
const LANES: usize = 4;
/// No more products are computed in advance, but for those of light that met no metal.
const MAX_PRODUCTS: usize = 1 << 16;

type Lanes = [f32; LANES];

/// The spectra of a scene at the wavelengths of one channel.
#[derive(Clone, Debug)]
struct ChannelTables {
    /// How many wavelengths count.
    wavelengths: usize,
    /// The wavelengths in the unit of [`Sigmoid`]s.
    wavelengths_t: Vec<Lanes>,
    /// The weights of the channel times the power of each light and last of ambient light.
    lights: Vec<Lanes>,
    /// All reflectances one after another, and last a perfect white.
    reflectances: Vec<Lanes>,
    tints: Vec<Lanes>,
}

/// The spectra of a scene, ready for each channel.
#[derive(Clone, Debug)]
pub(crate) struct Shader {
    tables: PerChannel<ChannelTables>,
    tints: Tints,
    /// How many lights there are, ambient light among them.
    lights: usize,
    /// How many reflectances there are, white among them.
    reflectances: usize,
    /// The light of a way of share 1, by [`Shader::products`]: A, C1, C2 and a place without a meaning, so that
    /// all are multiplied side by side.
    products: Vec<Lanes>,
}

impl Shader {
    /// Takes the spectra of a scene at the wavelengths of a rule.
    pub(crate) fn new(scene: &Scene, rule: &WavelengthRule) -> Self {
        let metals = scene
            .materials
            .iter()
            .filter_map(|material| match material.mirror {
                Some(Mirror::Metal { reflectance, .. }) => Some(reflectance),
                Some(Mirror::Coat { .. } | Mirror::Glass { .. }) | None => None,
            });
        let tints = Tints::of(metals);
        let (lights, reflectances) = (scene.lights.len() + 1, scene.reflectances.len() + 1);
        let of_each_tint = lights * reflectances;
        let multiplied = (MAX_PRODUCTS / of_each_tint).clamp(1, tints.len());
        let mut shader = Self {
            tables: PerChannel::from_fn(|c| ChannelTables::new(scene, rule, &tints, c)),
            tints,
            lights,
            reflectances,
            products: Vec::new(),
        };
        let products = (0..multiplied * of_each_tint).map(|product| {
            let [a, c1, c2] = Channel::ALL.map(|channel| shader.multiplied(product, channel));
            [a, c1, c2, 0.0]
        });
        shader.products = products.collect();
        shader
    }

    /// The place of the perfect white among the reflectances.
    pub(crate) fn white(&self) -> ReflectanceIndex {
        ReflectanceIndex::try_from(self.reflectances - 1).unwrap_or(ReflectanceIndex::MAX)
    }

    /// The place of ambient light among the lights.
    pub(crate) fn ambient(&self) -> u16 {
        u16::try_from(self.lights - 1).unwrap_or(u16::MAX)
    }

    /// What metals do to light.
    pub(crate) fn tints(&self) -> &Tints {
        &self.tints
    }

    /// How many wavelengths are computed for a channel.
    pub(crate) fn wavelengths(&self, channel: Channel) -> usize {
        self.tables[channel].wavelengths
    }

    /// The products of a reflectance seen by way of these metals, if they were computed: that of light n is
    /// n places on.
    #[inline]
    pub(crate) fn products(&self, tint: TintIndex, body: ReflectanceIndex) -> Option<u32> {
        let place = (usize::from(tint) * self.reflectances + usize::from(body)) * self.lights;
        (place < self.products.len()).then(|| u32::try_from(place).unwrap_or(u32::MAX))
    }

    /// The tristimulus value of a channel.
    #[inline]
    pub(crate) fn shade(&self, tree: &RayTree, channel: Channel) -> f32 {
        let tables = &self.tables[channel];
        let lane = channel as usize;
        let mut sum = 0.0;
        for path in tree.paths() {
            sum += path.share * self.products[path.product as usize][lane];
        }
        for (surface, shares) in tree.surfaces() {
            sum += tables.of_surface(surface, shares);
        }
        sum
    }

    /// The tristimulus values of all channels, in one pass: the same sums.
    #[inline]
    pub(crate) fn shade_all(&self, tree: &RayTree) -> PerChannel<f32> {
        let mut lanes: Lanes = [0.0; LANES];
        for path in tree.paths() {
            let products = &self.products[path.product as usize];
            for (sum, product) in lanes.iter_mut().zip(products) {
                *sum += path.share * product;
            }
        }
        let mut sums = PerChannel::from_fn(|channel| lanes[channel as usize]);
        for (surface, shares) in tree.surfaces() {
            for channel in Channel::ALL {
                sums[channel] += self.tables[channel].of_surface(surface, shares);
            }
        }
        sums
    }

    /// The same as [`Self::shade`] but for rounding, every way summed wavelength by wavelength.
    pub(crate) fn shade_by_wavelength(&self, tree: &RayTree, channel: Channel) -> f32 {
        let tables = &self.tables[channel];
        let of_paths = tree.paths().iter().map(|path| {
            let (surface, light) = self.way(path.product as usize);
            let share = LightShare {
                light,
                share: path.share,
            };
            tables.of_ways(surface, &[share])
        });
        let of_surfaces = tree
            .surfaces()
            .map(|(surface, shares)| tables.of_surface(surface, shares));
        of_paths.chain(of_surfaces).sum()
    }

    /// What a product is of: the reverse of [`Self::products`].
    pub(crate) fn way(&self, product: usize) -> (Way, u16) {
        let (rest, light) = (product / self.lights, product % self.lights);
        let way = Way {
            reflectance: rest % self.reflectances,
            tint: rest / self.reflectances,
        };
        (way, u16::try_from(light).unwrap_or(u16::MAX))
    }

    fn multiplied(&self, product: usize, channel: Channel) -> f32 {
        let tables = &self.tables[channel];
        let (way, light) = self.way(product);
        let groups = tables.wavelengths_t.len();
        let at = |table: &[Lanes], place: usize, group: usize, lane: usize| {
            f64::from(table[place * groups + group][lane])
        };
        let terms = (0..groups * LANES).map(|place| {
            let (group, lane) = (place / LANES, place % LANES);
            at(&tables.lights, usize::from(light), group, lane)
                * at(&tables.reflectances, way.reflectance, group, lane)
                * at(&tables.tints, way.tint, group, lane)
        });
        single(terms.sum())
    }
}

/// A reflectance of the scene and the metals by which it is seen.
#[derive(Clone, Copy)]
pub(crate) struct Way {
    pub(crate) reflectance: usize,
    pub(crate) tint: usize,
}

impl ChannelTables {
    fn new(scene: &Scene, rule: &WavelengthRule, tints: &Tints, channel: Channel) -> Self {
        let nodes = rule.nodes_of(channel);
        let in_lanes = |values: &dyn Fn(usize) -> f64| -> Vec<Lanes> {
            let groups = nodes.chunks(LANES).map(|group| {
                let mut lanes = [0.0; LANES];
                for (lane, &node) in lanes.iter_mut().zip(group) {
                    *lane = single(values(node));
                }
                lanes
            });
            groups.collect()
        };
        let emissions = scene.lights.iter().map(|light| Some(&light.emission));
        let ambient = scene.ambient.as_ref().map(|ambient| &ambient.emission);
        let lights = emissions.chain([ambient]).flat_map(|emission| {
            let power = emission.map(|emission| rule.power_at_nodes(emission));
            let weights = &rule.weights[channel];
            in_lanes(&|node| {
                power
                    .as_ref()
                    .map_or(0.0, |power| weights[node] * power[node])
            })
        });
        let spectra = scene.reflectances.iter();
        let mut reflectances: Vec<Lanes> = spectra
            .flat_map(|spectrum| in_lanes(&|node| spectrum.at(rule.nodes_nm[node])))
            .collect();
        reflectances.extend(in_lanes(&|_| 1.0));
        let tints = tints.metals().iter().flat_map(|metals| {
            let spectra = metals
                .iter()
                .map(|&metal| &scene.reflectances[usize::from(metal)]);
            in_lanes(&|node| spectra.clone().map(|s| s.at(rule.nodes_nm[node])).product())
        });
        Self {
            wavelengths: nodes.len(),
            wavelengths_t: in_lanes(&|node| Sigmoid::t(rule.nodes_nm[node])),
            lights: lights.collect(),
            reflectances,
            tints: tints.collect(),
        }
    }

    /// The light of a surface that was not multiplied in advance.
    fn of_surface(&self, surface: &LitSurface, shares: &[LightShare]) -> f32 {
        let tint = usize::from(surface.tint);
        match surface.reflectance {
            Reflectance::Table(reflectance) => {
                let reflectance = usize::from(reflectance);
                self.of_ways(Way { reflectance, tint }, shares)
            }
            Reflectance::Sigmoid(curve) => self.sum(tint, shares, |group| {
                self.wavelengths_t[group].map(|t| curve.single_at(t))
            }),
        }
    }

    fn of_ways(&self, way: Way, shares: &[LightShare]) -> f32 {
        let first = way.reflectance * self.wavelengths_t.len();
        self.sum(way.tint, shares, |group| self.reflectances[first + group])
    }

    /// The sum over wavelengths of lights × reflectance × tint.
    #[inline]
    fn sum(&self, tint: usize, shares: &[LightShare], reflectance: impl Fn(usize) -> Lanes) -> f32 {
        let groups = self.wavelengths_t.len();
        let mut sums: Lanes = [0.0; LANES];
        for group in 0..groups {
            let mut arriving: Lanes = [0.0; LANES];
            for share in shares {
                let light = &self.lights[usize::from(share.light) * groups + group];
                for lane in 0..LANES {
                    arriving[lane] += share.share * light[lane];
                }
            }
            let (reflectance, tint) = (reflectance(group), &self.tints[tint * groups + group]);
            for lane in 0..LANES {
                sums[lane] += arriving[lane] * reflectance[lane] * tint[lane];
            }
        }
        (sums[0] + sums[1]) + (sums[2] + sums[3])
    }
}

/// Rounds to single precision: 24 bits are far finer than a display's 8.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to the nearest single is meant"
)]
pub(crate) fn single(value: f64) -> f32 {
    value as f32
}
