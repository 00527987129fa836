//! A library of plugins that misbehave as their table says, for the tests of what the host
//! does about it: `do = "panic"`, `"hang"`, `"nan"`, `"nothing"`, `"silence"` or `"crash"`.

use seeone_plugin::{
    Action, Candidate, Felt, PluginError, Robot, RobotSample, RobotState, Setup, Transfer,
    TransferTask, Watch,
};

seeone_plugin::export_plugins! {
    Transfer "misbehaving" => Misbehaving::from_setup,
    Robot "misbehaving" => Misbehaving::from_setup,
}

/// What it does wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Misbehaving {
    Panic,
    Hang,
    NaN,
    Nothing,
    Silence,
    Freeze,
    Deaf,
}

impl Misbehaving {
    fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        match setup.config.get("do").and_then(toml::Value::as_str) {
            Some("panic") => Ok(Self::Panic),
            Some("hang") => Ok(Self::Hang),
            Some("nan") => Ok(Self::NaN),
            Some("nothing") => Ok(Self::Nothing),
            Some("silence") => Ok(Self::Silence),
            Some("freeze") => Ok(Self::Freeze),
            Some("deaf") => Ok(Self::Deaf),
            Some("crash") => std::process::abort(),
            other => Err(PluginError::Configuration(format!("do = {other:?} is not known"))),
        }
    }

    /// Panics, hangs or fails without a word; else nothing.
    fn misbehave(self) -> Result<(), PluginError> {
        match self {
            Self::Panic => panic!("as it was told"),
            Self::Hang | Self::Freeze | Self::Deaf => loop {
                std::thread::park();
            },
            Self::Silence => Err(PluginError::Internal(String::new())),
            Self::NaN | Self::Nothing => Ok(()),
        }
    }
}

impl Transfer for Misbehaving {
    fn transfer(&self, task: &TransferTask) -> Result<Vec<Candidate>, PluginError> {
        self.misbehave()?;
        let candidate = Candidate {
            pose: *task.demonstrated,
            loss: f64::NAN,
            confidence: 0.5,
            lay_on_surface: false,
            origin: "misbehaving".into(),
        };
        Ok(if *self == Self::NaN { vec![candidate] } else { Vec::new() })
    }
}

impl Robot for Misbehaving {
    fn state(&mut self) -> Result<RobotState, PluginError> {
        let joints = if *self == Self::Nothing { 0 } else { 6 };
        // Near where the shipped robot waits.
        let home = [0.0, -1.92, 1.4, -1.05, -1.5, 0.0];
        Ok(RobotState { joints: home[..joints].to_vec(), opening_m: 0.03 })
    }

    fn execute(&mut self, _: &Action, watch: &mut Watch) -> Result<Felt, PluginError> {
        match self {
            Self::Freeze => watch(&RobotSample { time_s: 0.5, state: self.state()? })?,
            Self::Deaf => return Err(PluginError::Internal("it does not move".into())),
            _ => {}
        }
        self.misbehave()?;
        let opening_m = if *self == Self::NaN { f64::NAN } else { 0.03 };
        Ok(Felt { opening_m, holding: false, contact: false })
    }

    fn stop(&mut self) -> Result<(), PluginError> {
        self.misbehave()
    }
}
