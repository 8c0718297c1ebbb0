//! The command's arguments.

use std::path::PathBuf;

/// What `--help` prints.
pub const HELP: &str = "\
Times contact queries of supersurface and of parry on the same random pairs of superellipsoids.

Usage: compare-contact [OPTIONS]

  --seed N            of the random pairs [1]
  --pairs N           pairs in each of the four regimes [1200]
  --shapes WHICH      sweep: all exponents of a pair are the same, 0.1 to 1.9 in ten steps, axis ratios
                      1, 3, 10, 20 in turn; mixed: each exponent and ratio drawn by itself [sweep]
  --json FILE         write the figures as JSON
  --write-pairs FILE  write the pairs, one a line, for compare/contact_coal.py
  --help              print this

Times are the wall clock's: run it on an idle core, as in `taskset -c 0 compare-contact`.
";

/// How exponents and axis ratios are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shapes {
    /// A grid of exponents, the same for both bodies of a pair, and of axis ratios.
    Sweep,
    /// Each exponent and each ratio by itself.
    Mixed,
}

impl Shapes {
    /// Its name as an argument.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sweep => "sweep",
            Self::Mixed => "mixed",
        }
    }
}

/// The arguments, checked.
#[derive(Debug)]
pub struct Options {
    /// Of the random pairs.
    pub seed: u64,
    /// Pairs in each regime.
    pub pairs: usize,
    /// How the bodies are drawn.
    pub shapes: Shapes,
    /// Where the figures go as JSON.
    pub json: Option<PathBuf>,
    /// Where the pairs go.
    pub write_pairs: Option<PathBuf>,
}

impl Options {
    /// `None` when help is asked for; otherwise the options, or what is wrong with them.
    pub fn parse(arguments: impl Iterator<Item = String>) -> Result<Option<Self>, String> {
        let mut options =
            Self { seed: 1, pairs: 1200, shapes: Shapes::Sweep, json: None, write_pairs: None };
        let mut arguments = arguments;
        while let Some(name) = arguments.next() {
            let mut value = || arguments.next().ok_or(format!("{name} needs a value"));
            match name.as_str() {
                "--help" | "-h" => return Ok(None),
                "--seed" => options.seed = number(&name, &value()?)?,
                "--pairs" => options.pairs = number(&name, &value()?)?,
                "--shapes" => {
                    options.shapes = match value()?.as_str() {
                        "sweep" => Shapes::Sweep,
                        "mixed" => Shapes::Mixed,
                        other => return Err(format!("--shapes is sweep or mixed, not '{other}'")),
                    }
                }
                "--json" => options.json = Some(value()?.into()),
                "--write-pairs" => options.write_pairs = Some(value()?.into()),
                _ => return Err(format!("unknown argument '{name}'")),
            }
        }
        if options.pairs == 0 {
            return Err("--pairs must be at least 1".into());
        }
        Ok(Some(options))
    }
}

fn number<T: std::str::FromStr>(name: &str, text: &str) -> Result<T, String> {
    text.parse().map_err(|_| format!("{name} needs a whole number from 0, not '{text}'"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Option<Options>, String> {
        Options::parse(text.split_whitespace().map(String::from))
    }

    #[test]
    fn what_is_asked_for_is_read() {
        let options = parse("--seed 7 --pairs 12 --shapes mixed --json f.json").unwrap().unwrap();
        assert_eq!((options.seed, options.pairs, options.shapes), (7, 12, Shapes::Mixed));
        assert_eq!(options.json, Some("f.json".into()));
        assert!(parse("--pairs 3 --help").unwrap().is_none());
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (text, told) in [
            ("--seed", "--seed needs a value"),
            ("--seed -1", "'-1'"),
            ("--pairs 0", "at least 1"),
            ("--shapes odd", "'odd'"),
            ("12", "'12'"),
        ] {
            assert!(parse(text).unwrap_err().contains(told), "{text}");
        }
    }
}
