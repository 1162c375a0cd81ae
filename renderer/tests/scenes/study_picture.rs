//! The picture of the study: section 3.4 of the paper says which colours it must have.

use protocols::PerChannel;
use renderer::{is_out_of_srgb_gamut, linear_srgb_from_ac1c2};

use super::*;

fn study() -> Scene {
    scene(include_str!("../../../stimuli/scenes/opponent-solids.toml"))
}

fn channels(sampler: &SceneSampler<'_>, tree: &RayTree) -> PerChannel<f64> {
    PerChannel::from_fn(|channel| f64::from(sampler.shade(tree, channel)))
}

/// The points of a grid over the screen.
fn grid(size: u32) -> impl Iterator<Item = ScreenPoint> {
    let at = move |place: u32| (f64::from(place) + 0.5) / f64::from(size);
    (0..size * size).map(move |point| ScreenPoint {
        x: at(point % size),
        y: at(point / size),
    })
}

/// Which pole of the opponent space a colour is near: by hue and saturation of linear sRGB.
fn pole([r, g, b]: [f64; 3]) -> Option<&'static str> {
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    if most < 0.02 {
        Some("black")
    } else if least > 0.5 && most < 1.3 * least {
        Some("white")
    } else if most < 0.2 {
        None
    } else if r > 4.0 * g && r > 4.0 * b {
        Some("red")
    } else if g > 2.0 * r && g > 2.0 * b {
        Some("green")
    } else if b > 2.5 * r && b > 2.0 * g {
        Some("blue")
    } else if r.min(g) > 4.0 * b && r.min(g) > 0.6 * r.max(g) {
        Some("yellow")
    } else {
        None
    }
}

#[test]
fn red_green_yellow_blue_white_and_black_each_fill_a_part() {
    let scene = study();
    let sampler = sampler(&scene);
    let mut tree = RayTree::default();
    let mut shares = std::collections::BTreeMap::new();
    let points = grid(320);
    for point in points {
        sampler.intersect(point, &mut tree);
        if let Some(pole) = pole(linear_srgb_from_ac1c2(channels(&sampler, &tree))) {
            *shares.entry(pole).or_insert(0) += 1;
        }
    }
    for pole in ["red", "green", "yellow", "blue", "white", "black"] {
        let share = f64::from(shares.get(pole).copied().unwrap_or(0)) / f64::from(320 * 320);
        assert!(share > 0.02, "{pole} fills {share} of the picture");
    }
}

#[test]
fn no_pixel_is_out_of_the_gamut_of_the_display() {
    // Nine rays in each pixel, averaged.
    let scene = study();
    let sampler = scene.sampler(Quadrature::Bands(16), [320, 320]);
    let mut tree = RayTree::default();
    for middle in grid(320) {
        let mut mean = [0.0; 3];
        for (dx, dy) in (0..9).map(|place| (f64::from(place % 3) - 1.0, f64::from(place / 3) - 1.0))
        {
            let (x, y) = (middle.x + dx / 960.0, middle.y + dy / 960.0);
            sampler.intersect(ScreenPoint { x, y }, &mut tree);
            let primaries = linear_srgb_from_ac1c2(channels(&sampler, &tree));
            for (mean, primary) in mean.iter_mut().zip(primaries) {
                *mean += primary / 9.0;
            }
        }
        assert!(!is_out_of_srgb_gamut(mean), "{mean:?} at {middle:?}");
    }
}

#[test]
fn every_ray_of_the_picture_meets_something() {
    let scene = study();
    let sampler = sampler(&scene);
    let mut tree = RayTree::default();
    for point in grid(320) {
        sampler.intersect(point, &mut tree);
        // Ambient light alone gives the darkest paint 2% of a hundredth.
        assert!(
            sampler.shade(&tree, Channel::A) > 0.0,
            "nothing at {point:?}"
        );
    }
}

#[test]
fn a_sample_is_the_same_in_any_order_on_any_thread_in_any_company() {
    let scene = study();
    let sampler = sampler(&scene);
    let points: Vec<ScreenPoint> = grid(60).collect();
    let all = |points: &mut dyn Iterator<Item = &ScreenPoint>| -> Vec<[u32; 3]> {
        let mut tree = RayTree::default();
        let bits = points.map(|&point| {
            sampler.intersect(point, &mut tree);
            Channel::ALL.map(|channel| sampler.shade(&tree, channel).to_bits())
        });
        bits.collect()
    };
    let forwards = all(&mut points.iter());
    let mut backwards = all(&mut points.iter().rev());
    backwards.reverse();
    assert_eq!(forwards, backwards);
    let halves = points.split_at(points.len() / 2);
    let threaded = std::thread::scope(|scope| {
        let first = scope.spawn(|| all(&mut halves.0.iter()));
        let second = all(&mut halves.1.iter());
        [first.join().unwrap(), second].concat()
    });
    assert_eq!(forwards, threaded);
    let mut fresh = RayTree::default();
    sampler.intersect(points[7], &mut fresh);
    assert_eq!(sampler.shade(&fresh, Channel::C1).to_bits(), forwards[7][1]);
}
