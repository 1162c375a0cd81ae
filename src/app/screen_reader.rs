//! The app's widgets for screen readers: egui's accessibility tree to AT-SPI, and a reader's actions back.
//!
//! eframe can do this by itself, but only together with Wayland and its C library; `accesskit_unix` needs neither.
//! Nothing is computed until a screen reader asks.

use std::sync::mpsc::{Receiver, Sender, channel};

use accesskit_unix::Adapter;
use eframe::egui::accesskit::{
    ActionHandler, ActionRequest, ActivationHandler, DeactivationHandler, TreeUpdate,
};
use eframe::egui::{Context, Event, FullOutput, Plugin, RawInput};

/// What a screen reader wants, from its thread to the window's.
enum Wanted {
    Tree,
    NoTree,
    Action(ActionRequest),
}

/// The ear of the adapter: it passes on what it hears, and wakes the window.
#[derive(Clone)]
struct Ear {
    wanted: Sender<Wanted>,
    context: Context,
}

impl Ear {
    fn hear(&self, wanted: Wanted) {
        // A window that is gone hears nothing.
        _ = self.wanted.send(wanted);
        self.context.request_repaint();
    }
}

impl ActivationHandler for Ear {
    fn request_initial_tree(&mut self) -> Option<TreeUpdate> {
        self.hear(Wanted::Tree);
        None
    }
}

impl ActionHandler for Ear {
    fn do_action(&mut self, request: ActionRequest) {
        self.hear(Wanted::Action(request));
    }
}

impl DeactivationHandler for Ear {
    fn deactivate_accessibility(&mut self) {
        self.hear(Wanted::NoTree);
    }
}

/// The bridge between the window and screen readers.
pub(crate) struct ScreenReader {
    adapter: Adapter,
    wanted: std::sync::Mutex<Receiver<Wanted>>,
}

impl ScreenReader {
    /// Offers the widgets of `context`'s window to screen readers.
    pub(crate) fn listen(context: &Context) {
        let (sender, wanted) = channel();
        let ear = Ear {
            wanted: sender,
            context: context.clone(),
        };
        let adapter = Adapter::new(ear.clone(), ear.clone(), ear);
        context.add_plugin(Self {
            adapter,
            wanted: std::sync::Mutex::new(wanted),
        });
    }
}

impl Plugin for ScreenReader {
    fn debug_name(&self) -> &'static str {
        "screen reader"
    }

    fn input_hook(&mut self, context: &Context, input: &mut RawInput) {
        self.adapter.update_window_focus_state(input.focused);
        let Ok(wanted) = self.wanted.get_mut() else {
            return;
        };
        for wanted in wanted.try_iter() {
            match wanted {
                Wanted::Tree => context.enable_accesskit(),
                Wanted::NoTree => context.disable_accesskit(),
                Wanted::Action(request) => {
                    input.events.push(Event::AccessKitActionRequest(request));
                }
            }
        }
    }

    fn output_hook(&mut self, _context: &Context, output: &mut FullOutput) {
        if let Some(update) = output.platform_output.accesskit_update.take() {
            self.adapter.update_if_active(|| update);
        }
    }
}
