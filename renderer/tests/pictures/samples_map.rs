//! The map of samples and depths, against the leaves themselves.

use exr::prelude::{FlatSamples, ReadChannels as _, ReadLayers as _};
use protocols::{Channel, PerChannel};
use renderer::{ImageRequest, Reach, SamplesMap, TracePlan, Watch, render_image_of, trace};

use crate::analytic::{disc_and_checks, plan};
use crate::small_study::{no_scene, request, small_study};

#[test]
fn samples_sum_to_the_rays_and_depths_are_those_of_the_leaves_at_the_centres() {
    let size_px = [37, 21];
    let chromatic = Reach {
        rays: 3000,
        depth: 7,
    };
    let reach = PerChannel {
        a: Reach::rays(2500),
        c1: chromatic,
        c2: Reach::rays(900),
    };
    let whole = TracePlan {
        size_px,
        ..plan(3000)
    };
    let tree = trace(&disc_and_checks(), &whole, &|_, _| ());
    let map = SamplesMap::new(&tree, reach, size_px);
    let sums = Channel::ALL.map(|channel| {
        let values = map.samples[channel].values().iter();
        values.copied().map(f64::from).sum::<f64>()
    });
    assert_eq!(sums, [2500.0, 128.0, 900.0]);
    for channel in Channel::ALL {
        // The plain way: every pixel asks every leaf.
        let leaves = tree.leaves(channel, reach[channel]).unwrap();
        for (place, &depth) in map.depths[channel].values().iter().enumerate() {
            let x = ((place % 37) as f64 + 0.5) / 37.0;
            let y = ((place / 37) as f64 + 0.5) / 21.0;
            let holds = |leaf: &&renderer::Leaf| {
                let cell = leaf.cell.rectangle();
                (cell.left..cell.left + cell.width).contains(&x)
                    && (cell.top..cell.top + cell.height).contains(&y)
            };
            let home = leaves.iter().find(holds).unwrap();
            assert_eq!(f64::from(depth), f64::from(home.cell.depth()));
        }
    }
    // The points of A's image, counted one by one.
    for (place, &count) in map.samples.a.values().iter().enumerate() {
        let (column, row) = ((place % 37) as f64, (place / 37) as f64);
        let is_inside = |point: &&renderer::ScreenPoint| {
            (point.x * 37.0).floor() == column && (point.y * 21.0).floor() == row
        };
        let points = tree.points();
        let inside = points[..2500].iter().filter(is_inside).count();
        assert_eq!(f64::from(count), inside as f64);
    }
}

#[test]
fn a_map_is_written_as_float_channels_and_as_a_sheet() {
    let folder = tempfile::tempdir().unwrap();
    let [numbers, sheet] = ["map.exr", "maps/map.png"].map(|name| folder.path().join(name));
    let request = ImageRequest {
        samples_maps: vec![numbers.clone(), sheet.clone()],
        ..request(&small_study(), 4000, 1000)
    };
    let out = folder.path().join("x.png");
    let (sampler, watch) = (disc_and_checks(), Watch::UNWATCHED);
    render_image_of(&sampler, no_scene(), &request, &out, &watch).unwrap();
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(&numbers)
        .unwrap();
    let channels = &image.layer_data.channel_data.list;
    let names: Vec<String> = channels.iter().map(|c| c.name.to_string()).collect();
    assert_eq!(
        names,
        [
            "A.depth",
            "A.samples",
            "C1.depth",
            "C1.samples",
            "C2.depth",
            "C2.samples"
        ]
    );
    let sum = |place: usize| match &channels[place].sample_data {
        FlatSamples::F32(values) => values.iter().sum::<f32>(),
        _ => f32::NAN,
    };
    assert_eq!([sum(1), sum(3), sum(5)], [4000.0, 1000.0, 1000.0]);
    let sheet = image::open(sheet).unwrap().into_rgb8();
    // 40 × 30 pixels, ten times enlarged, three beside each other and two rows.
    assert!(sheet.width() > 1200 && sheet.height() > 600);
    // Yellow, the end of the scale, is in the bar and in the pictures.
    let yellow = sheet
        .pixels()
        .filter(|pixel| pixel.0 == [253, 231, 37])
        .count();
    assert!(yellow > 100, "{yellow}");
}

#[test]
fn a_map_with_an_unknown_ending_is_refused_before_anything_is_traced() {
    let folder = tempfile::tempdir().unwrap();
    let request = ImageRequest {
        samples_maps: vec![folder.path().join("map.csv")],
        ..request(&small_study(), 4000, 1000)
    };
    let out = folder.path().join("x.png");
    let sampler = disc_and_checks();
    let error = render_image_of(&sampler, no_scene(), &request, &out, &Watch::UNWATCHED);
    assert!(error.unwrap_err().to_string().contains("map.csv"));
    assert_eq!(sampler.calls(), [0; 4]);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
