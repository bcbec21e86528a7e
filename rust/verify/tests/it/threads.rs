//! The same report on any number of threads, and a stop when asked.

use crate::common::{clothoid, limits, Levels, Part};
use std::time::Duration;
use styluscam_motion::{Cancelled, Watch};
use styluscam_verify::judge;

fn with_threads<R: Send>(count: usize, work: impl FnOnce() -> R + Send) -> R {
    rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap().install(work)
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let tool = clothoid(8.0);
    let part = Part::cone(true, 10.0, 30.0, 300, 10);
    let levels =
        Levels { tool: &tool, sheet: None, inner: true, low: 10.0, high: 30.0, levels: 5, points: 200, off: 0.0 };
    let mut program = levels.path().program(&tool);
    program.moves.iter_mut().step_by(37).for_each(|m| m.end.tip[2] -= 0.01);
    let tools = [tool.clone()];
    let subject = part.subject(&tools);
    let reports =
        [1, 2, 7].map(|n| with_threads(n, || judge(&program, &subject, &limits(), &Watch::default()).unwrap()));
    let texts = reports.map(|r| serde_json::to_string(&r).unwrap());
    assert_eq!(texts[0], texts[1]);
    assert_eq!(texts[0], texts[2]);
}

#[test]
fn it_stops_when_asked() {
    let tool = clothoid(8.0);
    let part = Part::cone(false, 10.0, 30.0, 300, 10);
    let levels =
        Levels { tool: &tool, sheet: None, inner: false, low: 10.0, high: 30.0, levels: 200, points: 1000, off: -3.0 };
    let program = levels.path().program(&tool);
    let tools = [tool.clone()];
    let subject = part.subject(&tools);
    let watch = Watch::default();
    std::thread::scope(|scope| {
        let running = scope.spawn(|| judge(&program, &subject, &limits(), &watch));
        while watch.state().1 < 0.001 {
            std::thread::sleep(Duration::from_millis(1));
        }
        watch.cancel();
        assert_eq!(running.join().unwrap().unwrap_err(), Cancelled);
        assert!(watch.state().1 < 0.5, "it went on: {:?}", watch.state());
    });
}
