//! Changes of source texts: operators, signs, numbers and calls, drawn by a seed.

use std::ops::Range;
use std::path::{Path, PathBuf};

use proc_macro2::Span;
use syn::spanned::Spanned as _;
use syn::visit::{self, Visit};
use syn::{Attribute, BinOp, Expr, Lit, UnOp};

use crate::{Asked, read};

/// An expression that another one takes the place of.
#[derive(Clone, Debug)]
pub struct Change {
    /// Its file, from the root.
    pub file: PathBuf,
    /// Its line.
    pub at: usize,
    /// Its bytes.
    pub range: Range<usize>,
    /// What stands there.
    pub from: String,
    /// What takes its place.
    pub to: String,
}

impl Change {
    /// The change in a line, with its place.
    pub fn line(&self) -> String {
        format!("{} (line {})", self.name(), self.at)
    }

    /// The change in a line, for the list of those that change nothing: lines move.
    pub fn name(&self) -> String {
        let short = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        format!("{}: `{}` -> `{}`", self.file.display(), short(&self.from), short(&self.to))
    }
}

/// Draws changes that do not overlap.
pub fn draw(root: &Path, files: &[PathBuf], asked: &Asked) -> Result<Vec<Change>, String> {
    let mut all = Vec::new();
    for file in files {
        let text = read(&root.join(file))?;
        let parsed = syn::parse_file(&text).map_err(|error| format!("{}: {error}", file.display()))?;
        let mut finder = Finder { file, text: &text, found: &mut all };
        finder.visit_file(&parsed);
    }
    fastrand::Rng::with_seed(asked.seed).shuffle(&mut all);
    let mut drawn: Vec<Change> = Vec::new();
    for change in all {
        let overlaps = |other: &Change| {
            other.file == change.file && other.range.start < change.range.end && change.range.start < other.range.end
        };
        if drawn.len() < asked.count && !drawn.iter().any(overlaps) {
            drawn.push(change);
        }
    }
    Ok(drawn)
}

/// Finds changes in a file.
struct Finder<'a> {
    file: &'a Path,
    text: &'a str,
    found: &'a mut Vec<Change>,
}

impl Finder<'_> {
    /// Adds a change of an expression, in which the bytes `part` become `with`.
    fn add(&mut self, whole: Span, part: Span, with: &str) {
        let (range, part) = (whole.byte_range(), part.byte_range());
        let from = self.text[range.clone()].to_owned();
        let to = [&self.text[range.start..part.start], with, &self.text[part.end..range.end]].concat();
        self.found.push(Change { file: self.file.to_owned(), at: whole.start().line, range, from, to });
    }
}

/// What an operator may be confused with.
fn confused(operator: &BinOp) -> &'static [&'static str] {
    match operator {
        BinOp::Add(_) => &["-"],
        BinOp::Sub(_) => &["+"],
        BinOp::Mul(_) => &["/"],
        BinOp::Div(_) => &["*"],
        BinOp::AddAssign(_) => &["-="],
        BinOp::SubAssign(_) => &["+="],
        BinOp::MulAssign(_) => &["/="],
        BinOp::Lt(_) => &["<=", ">"],
        BinOp::Le(_) => &["<", ">="],
        BinOp::Gt(_) => &[">=", "<"],
        BinOp::Ge(_) => &[">", "<="],
        BinOp::Eq(_) => &["!="],
        BinOp::Ne(_) => &["=="],
        BinOp::And(_) => &["||"],
        BinOp::Or(_) => &["&&"],
        _ => &[],
    }
}

/// Methods that may be confused.
const METHODS: [(&str, &str); 12] = [
    ("min", "max"),
    ("max", "min"),
    ("sin", "cos"),
    ("cos", "sin"),
    ("first", "last"),
    ("last", "first"),
    ("any", "all"),
    ("all", "any"),
    ("min_by", "max_by"),
    ("max_by", "min_by"),
    ("floor", "ceil"),
    ("ceil", "floor"),
];

/// Whether an expression binds names, as in `a && let Some(b) = c`: it cannot stand elsewhere.
fn binds(expr: &Expr) -> bool {
    struct Found(bool);
    impl Visit<'_> for Found {
        fn visit_expr_let(&mut self, _: &syn::ExprLet) {
            self.0 = true;
        }
    }
    let mut found = Found(false);
    found.visit_expr(expr);
    found.0
}

/// Whether an item is there for tests alone.
fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("test")
            || (attribute.path().is_ident("cfg")
                && attribute.meta.require_list().is_ok_and(|list| list.tokens.to_string() == "test"))
    })
}

impl<'ast> Visit<'ast> for Finder<'_> {
    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        if !is_test(&item.attrs) {
            visit::visit_item_mod(self, item);
        }
    }

    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        if item.sig.constness.is_none() && !is_test(&item.attrs) {
            visit::visit_block(self, &item.block);
        }
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        if item.sig.constness.is_none() && !is_test(&item.attrs) {
            visit::visit_block(self, &item.block);
        }
    }

    // Constants are computed by the compiler, types and patterns have no operators.
    fn visit_item_const(&mut self, _: &'ast syn::ItemConst) {}
    fn visit_impl_item_const(&mut self, _: &'ast syn::ImplItemConst) {}
    fn visit_item_static(&mut self, _: &'ast syn::ItemStatic) {}
    fn visit_item_enum(&mut self, _: &'ast syn::ItemEnum) {}
    fn visit_type(&mut self, _: &'ast syn::Type) {}
    fn visit_pat(&mut self, _: &'ast syn::Pat) {}
    fn visit_generic_argument(&mut self, _: &'ast syn::GenericArgument) {}
    fn visit_attribute(&mut self, _: &'ast Attribute) {}
    fn visit_expr_const(&mut self, _: &'ast syn::ExprConst) {}

    fn visit_expr_repeat(&mut self, expr: &'ast syn::ExprRepeat) {
        self.visit_expr(&expr.expr);
    }

    fn visit_expr_binary(&mut self, expr: &'ast syn::ExprBinary) {
        if !binds(&expr.left) && !binds(&expr.right) {
            for other in confused(&expr.op) {
                self.add(expr.span(), expr.op.span(), other);
            }
        }
        visit::visit_expr_binary(self, expr);
    }

    fn visit_expr_unary(&mut self, expr: &'ast syn::ExprUnary) {
        match &expr.op {
            UnOp::Neg(sign) => self.add(expr.span(), sign.span, ""),
            UnOp::Not(sign) => self.add(expr.span(), sign.span, ""),
            _ => {}
        }
        visit::visit_expr_unary(self, expr);
    }

    fn visit_expr_lit(&mut self, expr: &'ast syn::ExprLit) {
        if let Lit::Float(number) = &expr.lit {
            let more = format!("({} + 1.0)", number.token());
            self.add(expr.span(), expr.span(), &more);
        }
    }

    fn visit_expr_method_call(&mut self, expr: &'ast syn::ExprMethodCall) {
        let name = expr.method.to_string();
        if let Some((_, other)) = METHODS.iter().find(|(own, _)| *own == name) {
            self.add(expr.span(), expr.method.span(), other);
        }
        visit::visit_expr_method_call(self, expr);
    }
}
