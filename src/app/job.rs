//! Work on a thread of its own, so that no frame waits for it.
//!
//! A job is asked in every frame whether it is done; it wakes the window when it is. One that panics gives a
//! [`Fault`], never a window that waits for ever.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};

use eframe::egui::Context;
use renderer::Step;

use super::fault::Fault;

/// What the work may use of its job.
#[derive(Clone)]
pub(crate) struct Worker {
    context: Context,
    is_cancelled: Arc<AtomicBool>,
    step: Arc<Mutex<Option<Step>>>,
}

impl Worker {
    /// Tells how far the work has come.
    pub(crate) fn tell(&self, step: Step) {
        *self.step.lock().unwrap_or_else(PoisonError::into_inner) = Some(step);
        self.context.request_repaint();
    }

    /// Turns true when the work is to end early.
    pub(crate) fn is_cancelled(&self) -> &AtomicBool {
        &self.is_cancelled
    }
}

/// What happens to a job that is no longer wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WhenDropped {
    /// It is told to end, and waited for: it writes files.
    Await,
    /// It is left alone: it only reads, or it waits for a process that goes on by itself.
    Leave,
}

/// Work on a thread of its own.
pub(crate) struct Job<T> {
    answer: Receiver<T>,
    worker: Worker,
    thread: Option<JoinHandle<()>>,
    when_dropped: WhenDropped,
}

impl<T: Send + 'static> Job<T> {
    /// Begins `work`; `context` is the window that waits.
    pub(crate) fn start(
        context: &Context,
        when_dropped: WhenDropped,
        work: impl FnOnce(&Worker) -> T + Send + 'static,
    ) -> Self {
        let (sender, answer) = channel();
        let worker = Worker {
            context: context.clone(),
            is_cancelled: Arc::default(),
            step: Arc::default(),
        };
        let own = worker.clone();
        let thread = thread::spawn(move || {
            // Wakes the window also when the work panics; the sender is gone by then.
            let wake = Wake(own.context.clone());
            let sender: Sender<T> = sender;
            // Nobody waits any more if this fails.
            _ = sender.send(work(&own));
            drop(sender);
            drop(wake);
        });
        Self {
            answer,
            worker,
            thread: Some(thread),
            when_dropped,
        }
    }

    /// The answer, once; `None` while the work goes on.
    pub(crate) fn poll(&self) -> Option<Result<T, Fault>> {
        match self.answer.try_recv() {
            Ok(answer) => Some(Ok(answer)),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(Fault::of_program(
                "a piece of work stopped in the middle",
            ))),
        }
    }

    /// How far the work has come, if it said so.
    pub(crate) fn step(&self) -> Option<Step> {
        *(self.worker.step.lock()).unwrap_or_else(PoisonError::into_inner)
    }

    /// Tells the work to end early.
    pub(crate) fn cancel(&self) {
        self.worker.is_cancelled.store(true, Ordering::Relaxed);
    }

    /// Whether the work was told to end early.
    pub(crate) fn is_cancelled(&self) -> bool {
        self.worker.is_cancelled.load(Ordering::Relaxed)
    }
}

impl<T> Drop for Job<T> {
    fn drop(&mut self) {
        if self.when_dropped == WhenDropped::Await {
            self.worker.is_cancelled.store(true, Ordering::Relaxed);
            let ended = self.thread.take().map(JoinHandle::join);
            // Work that panicked has been reported, or is wanted no more.
            drop(ended);
        }
    }
}

/// Wakes the window when the thread ends, however it ends.
struct Wake(Context);

impl Drop for Wake {
    fn drop(&mut self) {
        self.0.request_repaint();
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    fn wait<T: Send + 'static>(job: &Job<T>) -> Result<T, Fault> {
        for _ in 0..1000 {
            if let Some(answer) = job.poll() {
                return answer;
            }
            thread::sleep(Duration::from_millis(5));
        }
        panic!("the job does not end");
    }

    #[test]
    fn work_answers_once_and_a_panic_becomes_a_fault() {
        let context = Context::default();
        let job = Job::start(&context, WhenDropped::Leave, |_| 7);
        assert_eq!(wait(&job).ok(), Some(7));
        let job = Job::<u8>::start(&context, WhenDropped::Leave, |_| panic!("on purpose"));
        assert!(
            wait(&job)
                .unwrap_err()
                .line()
                .contains("fault of the program")
        );
    }

    #[test]
    fn a_job_that_writes_is_ended_and_awaited() {
        let context = Context::default();
        let ended = Arc::new(AtomicBool::new(false));
        let told = Arc::clone(&ended);
        let job = Job::start(&context, WhenDropped::Await, move |worker| {
            while !worker.is_cancelled().load(Ordering::Relaxed) {
                thread::sleep(Duration::from_millis(1));
            }
            told.store(true, Ordering::Relaxed);
        });
        drop(job);
        assert!(ended.load(Ordering::Relaxed));
    }
}
