//! Every layout and scale: the pictures' bytes in their place, nothing preselected, and on disk what the hands meant.

use std::thread::sleep;
use std::time::Duration;

use protocols::rating::{RatingRow, ShownFirst};

use crate::display::{Display, Manager, Screenshot};
use crate::picture_study::{CLEAR, place, see, see_to_the_end};
use crate::{CONTINUE, Place, is_button, is_page, is_scale, output_of, rating_button};

/// The button below the bars.
const ENTER: [usize; 2] = [640, 911];
/// A button that nobody points at.
const IDLE: [u8; 3] = [180; 3];
const INK: [u8; 3] = [12; 3];

/// One session in its window.
struct Sitting<'a> {
    display: &'a Display,
    place: &'a Place,
    subject: &'static str,
    child: std::process::Child,
}

impl<'a> Sitting<'a> {
    /// Opens the window and leaves the instructions.
    fn begin(display: &'a Display, place: &'a Place, subject: &'static str) -> Self {
        let child = place.session(display, subject, "1").spawn().unwrap();
        display.wait_for("the instructions", is_page);
        display.click(CONTINUE);
        Self {
            display,
            place,
            subject,
            child,
        }
    }

    fn rated(&self) -> usize {
        self.place.rows(self.subject).len()
    }

    /// The row of the answer that was just given.
    fn row(&self, number: usize) -> RatingRow {
        self.place.wait_for_row(self.subject, number);
        let rows = self.place.rows(self.subject);
        assert_eq!(rows.len(), number);
        rows[number - 1].clone()
    }

    /// Something that must not be taken for an answer.
    fn takes_nothing(&self, is_there: impl Fn(&Screenshot) -> bool, hands: impl Fn(&Display)) {
        let before = self.rated();
        hands(self.display);
        sleep(Duration::from_millis(500));
        assert!(is_there(&self.display.screenshot()), "the scale is gone");
        assert_eq!(self.rated(), before);
    }

    /// The last screen, and the end.
    fn end(self, trials: usize) {
        sleep(Duration::from_millis(500));
        self.display.key("Return");
        let (code, text) = output_of(self.child);
        assert_eq!(code, Some(0), "{text}");
        assert!(
            text.contains(&format!("all {trials} trials rated")),
            "{text}"
        );
    }
}

/// The button of a grade, 1 to 5: 220 pixels apart (232 of 1080 lines).
fn grade(rating: usize, y: usize) -> [usize; 2] {
    [640 + 220 * rating - 660, y]
}

/// Five idle buttons in a row.
fn is_labelled(y: usize) -> impl Fn(&Screenshot) -> bool {
    move |shot| {
        let face = |rating| {
            let [x, y] = grade(rating, y);
            shot.pixel([x - 95, y])
        };
        let gap = |rating| shot.pixel([grade(rating, y)[0] + 110, y]);
        (1..=5).all(|rating| face(rating) == IDLE) && (1..=5).all(|rating| gap(rating) != IDLE)
    }
}

/// An upright bar without a mark: its middle column between its frames.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bar {
    x: usize,
    top: usize,
    bottom: usize,
}

impl Bar {
    /// The bars that a line across the screen meets.
    fn all(shot: &Screenshot) -> Vec<Self> {
        let is_face = |x: usize, y: usize| shot.pixel([x, y]) == IDLE;
        let mut bars = Vec::new();
        let mut x = 1;
        while x < 1280 {
            let start = x;
            while x < 1280 && is_face(x, 600) {
                x += 1;
            }
            if x > start + 30 {
                let middle = usize::midpoint(start, x);
                let above = (0..600).rev().take_while(|&y| is_face(middle, y));
                let below = (600..1024).take_while(|&y| is_face(middle, y));
                bars.push(Self {
                    x: middle,
                    top: 600 - above.count(),
                    bottom: 600 + below.count(),
                });
            }
            x += 1;
        }
        bars
    }

    /// Where a hundredth stands on it.
    fn at(self, hundredths: usize) -> [usize; 2] {
        let height = self.bottom - self.top;
        [self.x, self.bottom - (height * hundredths + 50) / 100]
    }
}

/// So many bars, each without a mark over its whole height (0.56 of 1024 lines, less its frame).
fn has_empty_bars(count: usize) -> impl Fn(&Screenshot) -> bool {
    move |shot| {
        let bars = Bar::all(shot);
        let is_empty = |bar: &Bar| (bar.bottom - bar.top).abs_diff(569) <= 4;
        bars.len() == count && bars.iter().all(is_empty) && is_button(shot, ENTER, 120)
    }
}

/// Double stimulus impairment: the original, then the picture; five grades. A press on the exposure is no answer, and
/// two clicks are one.
#[test]
fn dsis_with_five_grades() {
    let Some(display) = Display::open(Manager::Openbox) else {
        return;
    };
    let place = place(
        "layout = \"dsis\"\nresponse = \"labelled\"\nexposure_s = 2.5\npractice = []\n",
        [1, 5],
    );
    let sitting = Sitting::begin(&display, &place, "L1");
    let is_scale = is_labelled(512);
    for (number, rating) in [(1, 3), (2, 5), (3, 1)] {
        assert_eq!(see_to_the_end(&display, CLEAR), "original");
        let name = see(&display, CLEAR);
        assert!(["one", "two", "three"].contains(&name), "{name}");
        let there = grade(rating, 512);
        if number == 1 {
            display.press(there);
        }
        display.wait_for("five grades, none of them chosen", &is_scale);
        if number == 1 {
            display.move_to(there);
            sitting.takes_nothing(&is_scale, |display| {
                display.release();
                display.move_to([640, 700]);
            });
        }
        sitting.takes_nothing(&is_scale, |display| display.key("Return"));
        display.double_click(there);
        let row = sitting.row(number);
        assert_eq!(row.stimulus_id.as_str(), name);
        assert_eq!(usize::try_from(row.rating).unwrap(), rating);
        assert_eq!((row.reference_rating, row.shown_first), (None, None));
    }
    // The second click of each pair is in the log, as a click beside everything.
    assert_eq!(sitting.rated(), 3);
    sitting.end(3);
    assert!(place.count_events("L1", "stray_click") >= 3);
}

/// A single picture, judged on a bar from 0 to 100: by a click, by a drag, by keys.
#[test]
fn one_picture_on_a_continuous_bar() {
    let Some(display) = Display::open(Manager::Openbox) else {
        return;
    };
    let place = place(
        "layout = \"single\"\nresponse = \"continuous\"\nexposure_s = 2.5\npractice = []\n",
        [0, 100],
    );
    let sitting = Sitting::begin(&display, &place, "L2");
    let is_empty = has_empty_bars(1);
    for (number, expected) in [(1, 25), (2, 75), (3, 82)] {
        let name = see_to_the_end(&display, CLEAR);
        let shot = display.wait_for("a bar without a mark", &is_empty);
        let bar = Bar::all(&shot)[0];
        sitting.takes_nothing(&is_empty, |display| display.key("Return"));
        sitting.takes_nothing(&is_empty, |display| display.click(ENTER));
        match number {
            1 => display.click(bar.at(25)),
            2 => {
                display.press(bar.at(25));
                display.move_to(bar.at(50));
                display.move_to(bar.at(75));
                display.release();
            }
            _ => {
                display.write("81");
                display.key("Return");
                display.key("Up");
            }
        }
        let marked = bar.at(usize::try_from(expected).unwrap());
        display.wait_for("a mark where it was put", |shot| shot.pixel(marked) == INK);
        assert_eq!(sitting.rated(), number - 1, "a mark alone is no answer");
        if number == 1 {
            display.click(ENTER);
        } else {
            display.key("Return");
        }
        let row = sitting.row(number);
        assert_eq!((row.stimulus_id.as_str(), row.rating), (name, expected));
    }
    sitting.end(3);
}

/// A pair by lot, shown twice, both rated on bars of their own; what stood on the screen first is A.
#[test]
fn dscqs_with_two_bars() {
    let Some(display) = Display::open(Manager::Openbox) else {
        return;
    };
    let place = place(
        "layout = \"dscqs\"\nresponse = \"continuous\"\nexposure_s = 2.0\npractice = []\n",
        [0, 100],
    );
    let sitting = Sitting::begin(&display, &place, "L3");
    let is_empty = has_empty_bars(2);
    // The names A and B stand above the pictures.
    let below_names = 470..CLEAR.end;
    for number in 1..=3 {
        let shown: Vec<&str> = (0..4)
            .map(|_| see_to_the_end(&display, below_names.clone()))
            .collect();
        let [first, second] = [shown[0], shown[1]];
        assert_eq!(shown[2..], [first, second]);
        let shot = display.wait_for("two bars without a mark", &is_empty);
        let bars = Bar::all(&shot);
        sitting.takes_nothing(&is_empty, |display| display.key("Return"));
        display.click(bars[0].at(25));
        let one_marked = |shot: &Screenshot| {
            let y = bars[1].at(50)[1];
            shot.pixel(bars[0].at(25)) == INK && shot.pixel([bars[1].x, y]) == IDLE
        };
        sitting.takes_nothing(one_marked, |display| display.click(ENTER));
        display.click(bars[1].at(70));
        display.click(ENTER);
        let row = sitting.row(number);
        let (name, ratings, lot) = match (first, second) {
            ("original", test) => (test, (70, Some(25)), ShownFirst::Reference),
            (test, "original") => (test, (25, Some(70)), ShownFirst::Test),
            neither => panic!("{neither:?}"),
        };
        assert_eq!(row.stimulus_id.as_str(), name);
        assert_eq!((row.rating, row.reference_rating), ratings);
        assert_eq!(row.shown_first, Some(lot));
    }
    sitting.end(3);
}

/// The scale stands below the picture; an answer ends the exposure, and without one the scale stays.
#[test]
fn rating_during_the_exposure() {
    let Some(display) = Display::open(Manager::Openbox) else {
        return;
    };
    let place = place(
        "layout = \"single\"\nresponse = \"labelled\"\nrating = \"during-exposure\"\n\
         exposure_s = 8.0\npractice = []\n",
        [1, 5],
    );
    let sitting = Sitting::begin(&display, &place, "L4");
    let y = 880;
    let is_scale = is_labelled(y);
    for (number, rating) in [(1, 4), (2, 2), (3, 5)] {
        let name = see(&display, CLEAR.start..760);
        display.wait_for("five grades, none of them chosen", &is_scale);
        sitting.takes_nothing(&is_scale, |display| display.key("Return"));
        match number {
            1 => display.click(grade(rating, y)),
            2 => {
                display.write("2");
                display.key("Return");
            }
            _ => {
                display.wait_for("the end of the picture", |shot| {
                    crate::picture_study::picture_on(shot).is_none()
                });
                assert_eq!(sitting.rated(), 2);
                display.click(grade(rating, y));
            }
        }
        let row = sitting.row(number);
        assert_eq!(row.stimulus_id.as_str(), name);
        assert_eq!(usize::try_from(row.rating).unwrap(), rating);
        // To the end it is eight seconds, within a slow frame or two.
        let is_whole = row.exposure_submitted_s > 7.7;
        assert_eq!(is_whole, number == 3, "{row:?}");
    }
    sitting.end(3);
}

/// Zero anchor, picture, ten anchor, one after another; eleven numbers, by mouse and by keys.
#[test]
fn anchors_and_picture_in_sequence() {
    let Some(display) = Display::open(Manager::Openbox) else {
        return;
    };
    let place = place(
        "layout = \"sequence\"\nexposure_s = 2.0\npractice = []\n",
        [0, 10],
    );
    let sitting = Sitting::begin(&display, &place, "L5");
    for (number, rating) in [(1, 0), (2, 10), (3, 7)] {
        assert_eq!(see_to_the_end(&display, CLEAR), "worst");
        let name = see_to_the_end(&display, CLEAR);
        assert!(["one", "two", "three"].contains(&name), "{name}");
        assert_eq!(see_to_the_end(&display, CLEAR), "original");
        let shot = display.wait_for("eleven numbers", is_scale);
        for button in (0..=10).map(rating_button) {
            assert_eq!(shot.pixel([button[0] - 30, button[1]]), IDLE);
        }
        sitting.takes_nothing(is_scale, |display| display.key("Return"));
        if number == 1 {
            display.click(rating_button(0));
        } else {
            // Eleven is off the scale: it goes away.
            sitting.takes_nothing(is_scale, |display| {
                display.write("11");
                display.key("Return");
            });
            display.write(&rating.to_string());
            display.key("Return");
        }
        let row = sitting.row(number);
        assert_eq!((row.stimulus_id.as_str(), row.rating), (name, rating));
    }
    sitting.end(3);
}
