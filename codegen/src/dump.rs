//! Every stage of a compilation as text, for developers of the compiler.

use std::fmt::Write as _;

use crate::chain::{Analyses, Chain};
use crate::compile;
use crate::diagnostic::{Diagnostics, SourceFile};
use crate::explain::explain;
use crate::lower::{Loop, LoweredProgram, Statement, lower};
use crate::mechanics::derive;
use crate::program::Program;
use crate::read::read;
use crate::symbolic::{ExprId, Op};

/// A stage: name of a file, and the stage's result.
pub type Stage = (&'static str, String);

/// All stages of a spec, in the order of the pipeline: the spec as read, the chain, the program of expressions, its straight-line
/// code, and the Rust.
///
/// # Errors
/// All mistakes of the spec at once.
pub fn stages(source: &SourceFile, analyses: Option<Analyses>) -> Result<Vec<Stage>, Diagnostics> {
    let spec = read(source)?;
    let chain: Chain = compile::load(source)?;
    let analyses = analyses.unwrap_or(chain.analyses);
    let program = derive(&chain, analyses);
    let lowered = lower(&program, chain.loops.min_iterations());
    let code = compile::compile(source, Some(analyses))?.code;
    Ok(vec![
        ("1_spec.txt", format!("{spec:#?}\n")),
        ("2_chain.txt", format!("{}\n{chain:#?}\n", explain(&chain, Some(&code.report)))),
        ("3_program.txt", expressions(&program)),
        ("4_lines.txt", lines(&lowered)),
        ("5_module.rs", code.text),
    ])
}

/// An expression: its number, or its content if it costs nothing.
fn operand(program: &Program, id: ExprId) -> String {
    match program.op(id) {
        Op::Constant(constant) => constant.value().to_string(),
        Op::Symbol(symbol) => program.symbol(symbol).name.clone(),
        _ => match program.names.get(&id) {
            Some(name) => format!("%{}:{name}", id.index()),
            None => format!("%{}", id.index()),
        },
    }
}

/// `%7:sin_boom_psi = Sin(boom_psi)`
fn definition(program: &Program, id: ExprId) -> String {
    let op = program.op(id);
    let written = format!("{op:?}");
    let kind = written.split('(').next().unwrap_or_default();
    let order = if let Op::Stumpff(k, _) = op { k.to_string() } else { String::new() };
    let operands: Vec<String> = op.operands().map(|id| operand(program, id)).collect();
    format!("{} = {kind}{order}({})", operand(program, id), operands.join(", "))
}

/// Every function: its sweeps, then the expressions that only it adds, then its results.
fn expressions(program: &Program) -> String {
    let mut text = String::new();
    let mut written = vec![false; program.operations.len()];
    for function in &program.functions {
        let _ = writeln!(text, "{} -> {:?}\n  {}", function.id.name(), function.shape, function.doc);
        let needed = program.needed(function.outputs.iter().copied());
        for id in program.ids().filter(|id| needed[id.index()] && !program.op(*id).is_leaf()) {
            if !std::mem::replace(&mut written[id.index()], true) {
                let _ = writeln!(text, "  {}", definition(program, id));
            }
        }
        for (slot, id) in function.outputs.iter().enumerate() {
            let _ = writeln!(text, "  out[{slot}] = {}", operand(program, *id));
        }
        text.push('\n');
    }
    text
}

/// The constants, then every function statement by statement, piece by piece.
fn lines(lowered: &LoweredProgram<'_>) -> String {
    let program = &lowered.program;
    let mut text = String::from("constants of the live parameters\n");
    for id in &lowered.constants.stored {
        let _ = writeln!(text, "  {}", definition(program, *id));
    }
    for code in &lowered.functions {
        let inlined = code.inlined.iter().filter(|inlined| **inlined).count();
        let fused = code.fused.iter().flatten().count();
        let _ = writeln!(
            text,
            "\n{}: {} statements in {} pieces, {} values kept, {inlined} expressions within others, {fused} products fused",
            code.function.id.name(),
            code.statements(),
            code.pieces.len(),
            code.kept
        );
        for (number, piece) in code.pieces.iter().enumerate() {
            if code.pieces.len() > 1 {
                let _ = writeln!(text, "  piece {number}");
            }
            for line in piece {
                statement(&mut text, program, &code.rerolled.loops, line, "  ");
            }
        }
    }
    text
}

fn statement(text: &mut String, program: &Program, loops: &[Loop], line: &Statement, indent: &str) {
    let name = |id: &ExprId| operand(program, *id);
    let text_of_line = match line {
        Statement::Input(id) => format!("input {}", name(id)),
        Statement::Let(id) => definition(program, *id),
        Statement::At(Some(visit)) => format!("// {} {}", if visit.outward { "outward" } else { "inward" }, visit.body),
        Statement::At(None) => "// end of the sweeps".to_owned(),
        Statement::Output { slot, value } => format!("out[{slot}] = {}", name(value)),
        Statement::Keep { slot, value } => format!("carry[{slot}] = {}", name(value)),
        Statement::Fetch { slot, value } => format!("{} = carry[{slot}]", name(value)),
        Statement::Loop { of, body } => {
            let _ = writeln!(text, "{indent}loop {of}, {} iterations", loops[*of].iterations);
            for line in body {
                statement(text, program, loops, line, &format!("{indent}  "));
            }
            return;
        }
        Statement::SinCos(angles) => {
            let angles: Vec<String> = angles.iter().map(|known| name(&known.angle)).collect();
            format!("sines and cosines of {}", angles.join(", "))
        }
        Statement::Stumpff(arguments) => {
            let arguments: Vec<String> = arguments.iter().map(|known| name(&known.argument)).collect();
            format!("Stumpff's functions of {}", arguments.join(", "))
        }
    };
    let _ = writeln!(text, "{indent}{text_of_line}");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stage_is_there_and_names_what_it_hands_on() {
        let text = include_str!("../../specs/double_pendulum.yaml");
        let stages = stages(&SourceFile::new("double_pendulum.yaml", text), None).unwrap_or_else(|m| panic!("{m}"));
        let contains = |stage: usize, words: &str| {
            let (name, text) = &stages[stage];
            assert!(text.contains(words), "`{words}` not in {name}:\n{text}");
        };
        contains(0, "double_pendulum");
        contains(1, "upper_theta");
        contains(2, "Sin(upper_theta)");
        contains(2, "forward_dynamics -> Vector(2)");
        contains(3, "sines and cosines of upper_theta, lower_theta");
        contains(4, "pub fn forward_dynamics");
        assert_eq!(stages.len(), 5);
    }
}
