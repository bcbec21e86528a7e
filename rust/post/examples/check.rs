//! Tries every shipped machine out and says what did not come back.

use styluscam_post::{check, shipped, Machine, Outcome};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for name in shipped() {
        let machine = Machine::shipped(name)?;
        for trial in check(&machine)? {
            match trial.outcome {
                Outcome::Failed(error) => println!("{name}: {}: FAILED {error} | {}", trial.name, error.line()),
                Outcome::Without { reason } => println!("{name}: {}: without ({reason})", trial.name),
                Outcome::Passed => {}
            }
        }
    }
    Ok(())
}
