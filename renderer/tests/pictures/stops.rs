//! A stopped channel costs nothing: it is neither shaded nor stored, by ray count or by depth.

use crate::analytic::{Analytic, disc_and_checks, plan};
use protocols::{Channel, PerChannel, RefinementDriver};
use renderer::{Reach, TracePlan, reconstruct, trace};

fn stopped(a: Reach, chromatic: Reach) -> TracePlan {
    TracePlan {
        stops: PerChannel {
            a,
            c1: chromatic,
            c2: chromatic,
        },
        ..plan(1)
    }
}

/// The ray counts of one stimulus of the paper: A at 140K, C1 and C2 at 30K.
#[test]
fn chromatic_channels_at_30k_are_shaded_exactly_30k_times() {
    let sampler = disc_and_checks();
    let request = stopped(Reach::rays(140_000), Reach::rays(30_000));
    let tree = trace(&sampler, &request, &|_, _| ());
    assert_eq!(sampler.calls(), [140_000, 140_000, 30_000, 30_000]);
    let account = tree.account();
    assert_eq!(account.intersections, 140_000);
    assert_eq!(
        account.shadings,
        PerChannel {
            a: 140_000,
            c1: 30_000,
            c2: 30_000
        }
    );
    assert_eq!(account.saved_shadings(), 220_000);
    assert_eq!(tree.stored_samples(Channel::C1), 30_000);
    assert!(tree.leaves(Channel::C2, Reach::rays(30_000)).is_some());
    assert!(tree.leaves(Channel::C2, Reach::rays(30_001)).is_none());
    assert!(tree.estimates(Channel::C1, 30_001).is_none());
}

#[test]
fn stopping_the_chromatic_channels_leaves_a_as_it_is() {
    let full = trace(&disc_and_checks(), &plan(6000), &|_, _| ());
    for chromatic in [
        Reach::rays(777),
        Reach {
            rays: 6000,
            depth: 5,
        },
    ] {
        let request = stopped(Reach::rays(6000), chromatic);
        let tree = trace(&disc_and_checks(), &request, &|_, _| ());
        for rays in [777, 4321, 6000] {
            let reach = Reach::rays(rays);
            assert_eq!(
                tree.leaves(Channel::A, reach),
                full.leaves(Channel::A, reach)
            );
        }
        assert_eq!(
            tree.leaves(Channel::C1, chromatic),
            full.leaves(Channel::C1, chromatic)
        );
    }
}

#[test]
fn with_all_channels_driving_a_stopped_channel_changes_the_tree() {
    let all = |request: TracePlan| TracePlan {
        driver: RefinementDriver::All,
        ..request
    };
    // C1 alone has an edge, so that the tree follows it as long as C1 is shaded.
    let sampler = || {
        Analytic::new(|at, channel| match channel {
            Channel::A | Channel::C2 => at.y,
            Channel::C1 => f64::from(at.x > 0.3),
        })
    };
    let full = trace(&sampler(), &all(plan(3000)), &|_, _| ());
    let request = all(stopped(Reach::rays(3000), Reach::rays(100)));
    let tree = trace(&sampler(), &request, &|_, _| ());
    assert_eq!(tree.points()[..100], full.points()[..100]);
    assert_ne!(tree.points(), full.points());
}

#[test]
fn a_channel_driven_by_a_that_goes_further_than_the_image_of_a_has_the_same_tree() {
    let sampler = disc_and_checks();
    let tree = trace(
        &sampler,
        &stopped(Reach::rays(1000), Reach::rays(4000)),
        &|_, _| (),
    );
    let full = trace(&disc_and_checks(), &plan(4000), &|_, _| ());
    assert_eq!(tree.points(), full.points());
    // A alone says where to go, so it is shaded all the way.
    assert_eq!(sampler.calls(), [4000, 4000, 4000, 4000]);
}

/// Section 3.3: with stops at levels p, q, r a channel is found by descending to its own level only.
#[test]
fn below_its_depth_a_channel_is_neither_shaded_nor_stored() {
    let (p, q, r) = (12, 7, 4);
    let sampler = disc_and_checks();
    let stops = PerChannel {
        a: Reach {
            rays: 3000,
            depth: p,
        },
        c1: Reach {
            rays: 3000,
            depth: q,
        },
        c2: Reach {
            rays: 3000,
            depth: r,
        },
    };
    let tree = trace(&sampler, &TracePlan { stops, ..plan(1) }, &|_, _| ());
    let leaves = PerChannel::from_fn(|channel| tree.leaves(channel, stops[channel]).unwrap());
    for channel in Channel::ALL {
        let deepest = leaves[channel].iter().map(|leaf| leaf.cell.depth()).max();
        assert_eq!(deepest, Some(stops[channel].depth));
        let area: f64 = leaves[channel].iter().map(|leaf| leaf.cell.area()).sum();
        assert_eq!(area, 1.0);
        // One leaf, one sample: a channel is shaded once for each of its own leaves.
        assert_eq!(tree.stored_samples(channel), leaves[channel].len());
    }
    let counts = Channel::ALL.map(|channel| leaves[channel].len() as u64);
    assert_eq!(sampler.calls(), [3000, counts[0], counts[1], counts[2]]);
    assert_eq!(counts[2], 1 << r);
    assert!(tree.leaves(Channel::C2, Reach::rays(3000)).is_none());
    // Far fewer rectangles to filter: the saving in reconstruction.
    let _picture = reconstruct(&leaves.c2, [64, 64]);
    assert!(counts[1] < counts[0] / 10);
}

/// A tree that may be no deeper than p = 8 holds at most 2⁸ samples and then ends.
#[test]
fn a_tree_that_is_full_to_the_depth_of_a_ends() {
    let shallow = Reach {
        rays: 5000,
        depth: 8,
    };
    let tree = trace(&disc_and_checks(), &stopped(shallow, shallow), &|_, _| ());
    assert_eq!(tree.len(), 256);
}
