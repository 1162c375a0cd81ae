//! What holds for every scene of the project, whatever it is made of: the same bits on any number of threads,
//! from any longer trace, and from a channel that is stopped.

use std::fs;
use std::path::{Path, PathBuf};

use protocols::{Channel, PerChannel, Quadrature};
use renderer::{Leaf, Reach, Scene, ScreenTree, TracePlan, trace};

use crate::analytic::plan;

const SIZE_PX: [u32; 2] = [40, 30];

/// The scenes of the project and those that Mitsuba judges.
fn scenes() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = [
        root.join("../stimuli/scenes"),
        root.join("tests/mitsuba/scenes"),
    ];
    let mut files: Vec<PathBuf> = folders
        .iter()
        .flat_map(|folder| fs::read_dir(folder).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .collect();
    files.sort();
    assert!(files.len() > 4, "{files:?}");
    files
}

fn traced(scene: &Scene, request: &TracePlan, threads: usize) -> ScreenTree {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    let sampler = scene.sampler(Quadrature::Bands(16), SIZE_PX);
    let request = TracePlan {
        size_px: SIZE_PX,
        ..request.clone()
    };
    pool.install(|| trace(&sampler, &request, &|_, _| ()))
}

/// Cells and the bits of their values.
fn bits(tree: &ScreenTree, reach: Reach) -> PerChannel<Vec<(renderer::Cell, u32)>> {
    let of_leaf = |leaf: &Leaf| (leaf.cell, leaf.value.to_bits());
    PerChannel::from_fn(|channel| {
        let leaves = tree.leaves(channel, reach).unwrap();
        leaves.iter().map(of_leaf).collect()
    })
}

#[test]
fn every_scene_is_the_same_on_any_number_of_threads_and_in_every_longer_trace() {
    for path in scenes() {
        let scene = Scene::read(&path).unwrap();
        let rays = 2500;
        let alone = traced(&scene, &plan(rays), 1);
        for threads in [2, 3, 8] {
            let other = traced(&scene, &plan(rays), threads);
            assert!(
                bits(&other, Reach::rays(rays)) == bits(&alone, Reach::rays(rays)),
                "{} on {threads} threads",
                path.display()
            );
        }
        for fewer in [64, 1000, 1234] {
            let short = traced(&scene, &plan(fewer), 2);
            assert!(
                bits(&short, Reach::rays(fewer)) == bits(&alone, Reach::rays(fewer)),
                "{} at {fewer} rays",
                path.display()
            );
        }
    }
}

#[test]
fn in_every_scene_a_stopped_channel_is_the_full_one_as_far_as_it_goes() {
    for path in scenes() {
        let scene = Scene::read(&path).unwrap();
        let full = traced(&scene, &plan(2500), 2);
        for chromatic in [
            Reach::rays(700),
            Reach {
                rays: 2500,
                depth: 7,
            },
        ] {
            let stops = PerChannel {
                a: Reach::rays(2500),
                c1: chromatic,
                c2: chromatic,
            };
            let stopped = traced(
                &scene,
                &TracePlan {
                    stops,
                    ..plan(2500)
                },
                2,
            );
            for channel in Channel::ALL {
                let reach = stops[channel];
                assert_eq!(
                    stopped.leaves(channel, reach),
                    full.leaves(channel, reach),
                    "{} {channel}",
                    path.display()
                );
            }
        }
    }
}
