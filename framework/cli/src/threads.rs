//! One thread a piece of work.

/// How many threads candle splits a large elementwise operation over. They wait for each other
/// by spinning; ours work on whole samples and clouds instead, and lose up to half their time
/// to it. candle reads this once and has no other switch.
#[cfg(unix)]
const CANDLE_THREADS: &str = "CANDLE_NUM_THREADS";

/// Starts the program anew with candle kept to one thread, unless the variable is set (as
/// cargo does by `.cargo/config.toml`). A program may not safely set a variable of its own.
/// Where it cannot be started anew it goes on, slower.
#[cfg(unix)]
pub fn keep_candle_to_one() {
    use std::os::unix::process::CommandExt;
    if std::env::var_os(CANDLE_THREADS).is_some() {
        return;
    }
    let mut arguments = std::env::args_os();
    let (Ok(program), Some(name)) = (std::env::current_exe(), arguments.next()) else { return };
    let mut again = std::process::Command::new(program);
    let _ = again.arg0(name).args(arguments).env(CANDLE_THREADS, "1").exec();
}

/// As above, where no program can take another's place: nothing.
#[cfg(not(unix))]
pub fn keep_candle_to_one() {}
