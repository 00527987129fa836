//! What a user reads when something is wrong: place, cause, hint.

use std::fmt;
use std::path::{Path, PathBuf};

/// Where in a file a fault lies; line and column count from one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file as the user named it.
    pub file: PathBuf,
    /// Line and column, where the format has them.
    pub at: Option<(usize, usize)>,
}

/// A fault in something the user gave, told so that it can be mended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// A stable code such as `S012`.
    pub code: &'static str,
    /// Where it lies, when it lies in a file.
    pub place: Option<Place>,
    /// What is wrong.
    pub cause: String,
    /// What would mend it.
    pub hint: Option<String>,
}

impl Diagnostic {
    /// A fault without a place.
    pub fn new(code: &'static str, cause: impl Into<String>) -> Self {
        Self { code, place: None, cause: cause.into(), hint: None }
    }

    /// The same fault, lying in `file`.
    pub fn in_file(mut self, file: &Path) -> Self {
        self.place = Some(Place { file: file.to_owned(), at: None });
        self
    }

    /// The same fault, lying at the byte `offset` of `text`, which was read from `file`.
    pub fn at_offset(mut self, file: &Path, text: &str, offset: usize) -> Self {
        let before = text.get(..offset.min(text.len())).unwrap_or(text);
        let line = before.matches('\n').count() + 1;
        let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
        self.place = Some(Place { file: file.to_owned(), at: Some((line, column)) });
        self
    }

    /// The same fault with a line of its file.
    pub fn at_line(mut self, file: &Path, line: usize, column: usize) -> Self {
        self.place = Some(Place { file: file.to_owned(), at: Some((line, column)) });
        self
    }

    /// The same fault with advice.
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// The same fault with the nearest of `candidates` as advice, or all of them.
    pub fn suggest<'a>(self, wrong: &str, candidates: impl IntoIterator<Item = &'a str>) -> Self {
        let candidates: Vec<&str> = candidates.into_iter().collect();
        let nearest = candidates
            .iter()
            .map(|c| (strsim::damerau_levenshtein(wrong, c), *c))
            .min()
            .filter(|(distance, _)| *distance <= 2.max(wrong.len() / 3));
        match nearest {
            Some((_, name)) => self.hint(format!("did you mean \"{name}\"?")),
            None if candidates.is_empty() => self,
            None => self.hint(format!("known: {}", candidates.join(", "))),
        }
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "error[{}]: ", self.code)?;
        if let Some(place) = &self.place {
            write!(f, "{}", place.file.display())?;
            if let Some((line, column)) = place.at {
                write!(f, ":{line}:{column}")?;
            }
            write!(f, ": ")?;
        }
        write!(f, "{}", self.cause)?;
        if let Some(hint) = &self.hint {
            write!(f, "\n\nhint: {hint}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostic {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_as_documented() {
        let text = "schema = 1\n  spede = 2\n";
        let told = Diagnostic::new("S012", "unknown key \"spede\"")
            .at_offset(Path::new("skills/a.toml"), text, 13)
            .suggest("spede", ["speed", "name"]);
        assert_eq!(
            told.to_string(),
            "error[S012]: skills/a.toml:2:3: unknown key \"spede\"\n\nhint: did you mean \"speed\"?"
        );
    }
}
