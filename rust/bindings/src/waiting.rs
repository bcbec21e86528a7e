//! Long calls: the work runs in a thread of its own without the GIL, the calling thread reports and listens.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{mpsc, Arc};
use std::time::Duration;

use pyo3::prelude::*;
use pyo3::types::PyBool;
use styluscam_motion::Watch;

use crate::errors;

/// Progress is reported, and Ctrl-C and cancellation are looked at, this often.
const INTERVAL: Duration = Duration::from_millis(50);

/// Cancels a call from another thread.
#[pyclass(frozen, module = "styluscam")]
#[derive(Default)]
pub struct CancelToken {
    flag: Arc<AtomicBool>,
}

#[pymethods]
impl CancelToken {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// Asks the call that holds this token to stop; it raises `Cancelled` within 0.2 s.
    fn cancel(&self) {
        self.flag.store(true, Ordering::Relaxed);
    }

    /// Whether `cancel` was called.
    #[getter]
    fn cancelled(&self) -> bool {
        self.flag.load(Ordering::Relaxed)
    }
}

/// Runs `work` in a thread. `progress(phase, fraction)` is called on this one: `False` cancels, an exception passes through.
pub fn watched<T: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    cancel: Option<&CancelToken>,
    work: impl FnOnce(&Watch) -> T + Send,
) -> PyResult<T> {
    if let Some(given) = progress.filter(|given| !given.is_callable()) {
        let message = format!(
            "progress: expected a function of phase and fraction, got a value of type {}",
            given.get_type().name()?
        );
        return Err(errors::raise("StylusError", &message, "argument", "progress", ""));
    }
    let watch = Watch::default();
    let watch = &watch;
    let (done, result) = mpsc::channel();
    std::thread::scope(|scope| {
        scope.spawn(move || {
            // the receiver waits until this is sent: it is there
            let _ = done.send(work(watch));
        });
        let mut interrupted = None;
        let mut result = result;
        loop {
            let (received, back) = py.detach(move || (result.recv_timeout(INTERVAL), result));
            result = back;
            match received {
                Ok(value) => return interrupted.map_or(Ok(value), Err),
                Err(mpsc::RecvTimeoutError::Disconnected) => {
                    return Err(crate::errors::raise(
                        "StylusError",
                        "the engine stopped unexpectedly",
                        "internal",
                        "",
                        "please report this",
                    ));
                }
                Err(mpsc::RecvTimeoutError::Timeout) if interrupted.is_none() => {
                    if let Err(reason) = look_around(py, progress, cancel, watch) {
                        watch.cancel();
                        interrupted = Some(reason);
                    }
                }
                Err(mpsc::RecvTimeoutError::Timeout) => {}
            }
        }
    })
}

fn look_around(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    cancel: Option<&CancelToken>,
    watch: &Watch,
) -> PyResult<()> {
    py.check_signals()?;
    if cancel.is_some_and(CancelToken::cancelled) {
        return Err(crate::errors::cancelled(styluscam_motion::Cancelled));
    }
    let Some(progress) = progress else { return Ok(()) };
    let answer = progress.call1(watch.state())?;
    if answer.is_exact_instance_of::<PyBool>() && !answer.is_truthy()? {
        return Err(crate::errors::cancelled(styluscam_motion::Cancelled));
    }
    Ok(())
}
