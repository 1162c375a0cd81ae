//! The app without a mouse and without eyes: every control has a name, and Tab leads to each.

use super::*;

/// Roles that a hand works.
const CONTROLS: [Role; 6] = [
    Role::Button,
    Role::CheckBox,
    Role::RadioButton,
    Role::Slider,
    Role::Tab,
    Role::TextInput,
];

impl User<'_> {
    /// The names of the controls of the page, in their order; each must have one, and no other the same.
    fn controls(&self, page: &str) -> Vec<String> {
        let nodes = self.harness.root().children_recursive();
        let controls = nodes.filter(|node| CONTROLS.contains(&node.accesskit_node().role()));
        let names: Vec<String> = controls
            .map(|node| node.accesskit_node().label().unwrap_or_default())
            .collect();
        for (index, name) in names.iter().enumerate() {
            assert!(!name.trim().is_empty(), "a control of {page} has no name");
            assert!(!names[..index].contains(name), "{page}: two are {name:?}");
        }
        names
    }

    /// Tab leads to every control that is enabled, before it leads to one again.
    fn tab_through(&mut self, page: &str) {
        let names = self.controls(page);
        let enabled = names.iter().filter(|name| self.is_enabled(name));
        let mut missing: Vec<String> = enabled.cloned().collect();
        assert!(missing.len() > 3, "{page}: {names:?}");
        for _ in 0..2 * names.len() {
            self.harness.key_press(Key::Tab);
            self.harness.run_steps(2);
            let focused = self.focused();
            missing.retain(|name| *name != focused);
        }
        assert!(missing.is_empty(), "{page}: no Tab leads to {missing:?}");
    }

    fn press(&mut self, name: &str, key: Key) {
        self.tab_to(name);
        self.harness.key_press(key);
        self.harness.run_steps(3);
    }
}

#[test]
fn from_the_welcome_to_a_session_without_a_mouse() {
    let fixture = Fixture::new();
    let mut user = User::at(&fixture);
    user.launcher.answer(Some(0), "the end of it");
    user.wait("small.toml");
    user.press("small.toml", Key::Enter);
    user.wait("Stimuli:");
    user.press("Make the stimuli", Key::Enter);
    user.wait("28 images ready");
    user.press("Sessions", Key::Space);
    user.press("Experimenter's view", Key::Space);
    user.press("Next subject", Key::Enter);
    assert_eq!(user.focused(), "Start session 01");
    user.harness.key_press(Key::Space);
    user.wait("the end of it");
    let wanted = user.launcher.wanted();
    assert_eq!(wanted[0][2..4], ["--subject", "01"]);
    assert_eq!(wanted[0][6], "--experimenter");
}

#[test]
fn every_control_has_a_name_of_its_own_and_tab_leads_to_it() {
    let fixture = ready();
    let sessions = fixture.simulate_people(4);
    fixture.make_report();
    Fixture::cut_to(&sessions[1], 12);
    Fixture::cut_to(&sessions[2], 3);
    let mut user = User::at(&fixture);
    user.wait("small.toml");
    user.tab_through("welcome");
    user.click("small.toml");
    user.wait("Stimuli:");
    for step in Step::ALL {
        user.go(step.name());
        user.tab_through(step.name());
    }
    user.go("Station");
    user.click("Type the width");
    user.tab_through("the station's form");
    user.go("Sessions");
    let close = format!("Close subject {}", sessions[1].subject);
    for panel in ["Next subject", "Trial run", &close] {
        user.click(panel);
        user.tab_through(panel);
        user.harness.key_press(Key::Escape);
        user.harness.run_steps(3);
        assert!(user.is_enabled("Next subject"), "Escape leaves {panel}");
    }
}
