//! The named variables of a network.

use candle_core::backprop::GradStore;
use candle_core::{Device, Result, Tensor, Var, bail};
use seeone_core::random::{Generator, generator, normal};

/// Named variables in the order in which the network asked for them.
///
/// A network is built by asking for its variables; every one is drawn from the seed, and
/// stored weights replace the values afterwards.
pub struct Parameters {
    entries: Vec<(String, Var)>,
    rng: Generator,
}

impl Parameters {
    /// No variables yet; `seed` decides the initial values of those to come.
    pub fn new(seed: u64) -> Self {
        Self { entries: Vec::new(), rng: generator(seed, "initial weights") }
    }

    /// A matrix of `inputs` x `outputs` normal numbers of variance `gain / inputs`
    /// (He et al. 2015: gain 2 before a rectifier, 1 otherwise).
    ///
    /// # Errors
    /// When the name is taken.
    pub fn weight(
        &mut self,
        name: &str,
        inputs: usize,
        outputs: usize,
        gain: f64,
    ) -> Result<Tensor> {
        let deviation = (gain / inputs.max(1) as f64).sqrt();
        let values: Vec<f32> =
            (0..inputs * outputs).map(|_| (deviation * normal(&mut self.rng)) as f32).collect();
        self.insert(name, Tensor::from_vec(values, (inputs, outputs), &Device::Cpu)?)
    }

    /// A vector of `length` equal numbers.
    ///
    /// # Errors
    /// When the name is taken.
    pub fn constant(&mut self, name: &str, length: usize, value: f32) -> Result<Tensor> {
        self.insert(name, Tensor::from_vec(vec![value; length], length, &Device::Cpu)?)
    }

    /// A variable with given initial values.
    ///
    /// # Errors
    /// When the name is taken.
    pub fn insert(&mut self, name: &str, values: Tensor) -> Result<Tensor> {
        if self.entries.iter().any(|(taken, _)| taken == name) {
            bail!("two variables are called {name}");
        }
        let var = Var::from_tensor(&values)?;
        let tensor = var.as_tensor().clone();
        self.entries.push((name.to_owned(), var));
        Ok(tensor)
    }

    /// Names and variables.
    pub fn entries(&self) -> impl Iterator<Item = (&str, &Var)> {
        self.entries.iter().map(|(name, var)| (name.as_str(), var))
    }

    /// How many numbers all variables hold together.
    pub fn count(&self) -> usize {
        self.entries.iter().map(|(_, var)| var.elem_count()).sum()
    }

    /// All numbers, one variable after the other.
    ///
    /// # Errors
    /// What candle reports.
    pub fn values(&self) -> Result<Vec<f32>> {
        let mut all = Vec::with_capacity(self.count());
        for (_, var) in &self.entries {
            all.extend(var.flatten_all()?.to_vec1::<f32>()?);
        }
        Ok(all)
    }

    /// Replaces all numbers, in the order of [`Parameters::values`].
    ///
    /// # Errors
    /// When there are too few or too many.
    pub fn set_values(&self, values: &[f32]) -> Result<()> {
        if values.len() != self.count() {
            bail!("{} numbers for {} of a network", values.len(), self.count());
        }
        let mut rest = values;
        for (_, var) in &self.entries {
            let (own, after) = rest.split_at(var.elem_count());
            var.set(&Tensor::from_slice(own, var.dims(), &Device::Cpu)?)?;
            rest = after;
        }
        Ok(())
    }

    /// Gradients in the order of [`Parameters::values`]; zero for variables that took no
    /// part.
    ///
    /// # Errors
    /// What candle reports.
    pub fn gradients(&self, store: &GradStore) -> Result<Vec<f32>> {
        let mut all = Vec::with_capacity(self.count());
        for (_, var) in &self.entries {
            match store.get(var) {
                Some(gradient) => all.extend(gradient.flatten_all()?.to_vec1::<f32>()?),
                None => all.resize(all.len() + var.elem_count(), 0.0),
            }
        }
        Ok(all)
    }
}
