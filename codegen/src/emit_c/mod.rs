//! C text from straight-line code, for controllers: C99 without a heap, global data or recursion. The only module that knows C.
//!
//! The output is a header and a source with the requested functions. Repeated work is not turned into loops: a crane with at most some
//! tens of elements fits a controller as straight-line code, and needs no tables.

mod arithmetic;
mod function;
mod head;
mod rt;
mod variables;
mod words;

use crate::chain::Chain;
use crate::emit::Labels;
use crate::lower::LoweredProgram;
use function::CWriter;

pub use variables::variables;

/// The type of all numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// `double`
    #[default]
    Double,
    /// `float`
    Single,
}

impl Precision {
    /// Its name in C.
    fn name(self) -> &'static str {
        match self {
            Precision::Double => "double",
            Precision::Single => "float",
        }
    }

    /// Suffix of function names and of numbers.
    fn suffix(self) -> &'static str {
        match self {
            Precision::Double => "",
            Precision::Single => "f",
        }
    }
}

/// A crane in C.
#[derive(Clone, Debug)]
pub struct CCode {
    /// Name of the crane: prefix of every name in both files.
    pub name: String,
    /// The header, which the source includes by its name.
    pub header: String,
    /// The source.
    pub source: String,
}

/// Writes all functions of the lowered program of a crane; `parameters` are the initial values of the live parameters, `header` is the
/// name of the header's file.
///
/// # Panics
/// If a function has loops, or a result that is left as factors: chains with [`Loops::Never`](crate::chain::Loops) have neither.
#[must_use]
pub fn emit_c(
    chain: &Chain,
    lowered: &LoweredProgram,
    parameters: &[f64],
    precision: Precision,
    header: &str,
) -> CCode {
    let labels = Labels::new(chain, lowered);
    let writer = CWriter { chain, lowered, labels: &labels, parameters, precision };
    let functions: String = lowered.functions.iter().map(|code| writer.function(code)).collect();
    let (constants, inputs) = (writer.constants(), writer.inputs());
    let body = format!("{constants}{inputs}{functions}");
    let source = format!("{}{}{body}", head::source(chain, header), rt::used(&body, precision));
    CCode { name: chain.name.clone(), header: head::header(&writer), source }
}
