//! Rust expressions as syntax nodes.
//!
//! Built as nodes, never quoted: `quote!(#sum * c)` would lose the parentheses of `a + b`.

use proc_macro2::Span;
use syn::punctuated::Punctuated;
use syn::{
    BinOp, Expr, ExprBinary, ExprCall, ExprParen, ExprPath, ExprReference, ExprUnary, Ident, Lit, Token, UnOp,
    parse_quote,
};

use crate::lower::Progression;

/// A variable or path of one word.
pub fn variable(name: &str) -> Expr {
    let ident = Ident::new(name, Span::call_site());
    Expr::Path(ExprPath { attrs: vec![], qself: None, path: ident.into() })
}

/// A number; its sign is an operator. `{:?}` prints the shortest digits that read back as the same number.
pub fn literal(value: f64) -> Expr {
    debug_assert!(value.is_finite(), "{value} in generated code");
    let literal = syn::LitFloat::new(&format!("{:?}", value.abs()), Span::call_site());
    let magnitude = Expr::Lit(syn::ExprLit { attrs: vec![], lit: Lit::Float(literal) });
    if value.is_sign_negative() { negative(magnitude) } else { magnitude }
}

/// An integer literal without a type.
pub fn integer(value: usize) -> Expr {
    let literal = syn::LitInt::new(&value.to_string(), Span::call_site());
    Expr::Lit(syn::ExprLit { attrs: vec![], lit: Lit::Int(literal) })
}

/// −a; −(−2) becomes 2, and `−(2 · b)` becomes `−2 · b`, the same number with one operation fewer.
pub fn negative(a: Expr) -> Expr {
    let a = match a {
        Expr::Binary(ExprBinary { left, op: op @ BinOp::Mul(_), right, .. }) if matches!(*left, Expr::Lit(_)) => {
            return binary(negative(*left), op, *right);
        }
        Expr::Unary(ExprUnary { op: UnOp::Neg(_), expr, .. }) if matches!(*expr, Expr::Lit(_)) => return *expr,
        other => other,
    };
    let operand = if precedence(&a) < Precedence::Unary { parenthesised(a) } else { a };
    Expr::Unary(ExprUnary { attrs: vec![], op: UnOp::Neg(Token![-](Span::call_site())), expr: Box::new(operand) })
}

/// a + b; `a + −2` becomes `a − 2`.
pub fn sum(a: Expr, b: Expr) -> Expr {
    if let Expr::Unary(ExprUnary { op: UnOp::Neg(_), expr, .. }) = &b
        && matches!(**expr, Expr::Lit(_))
    {
        return difference(a, (**expr).clone());
    }
    binary(a, BinOp::Add(Token![+](Span::call_site())), b)
}

/// a − b
pub fn difference(a: Expr, b: Expr) -> Expr {
    binary(a, BinOp::Sub(Token![-](Span::call_site())), b)
}

/// a · b
pub fn product(a: Expr, b: Expr) -> Expr {
    binary(a, BinOp::Mul(Token![*](Span::call_site())), b)
}

/// a / b
pub fn quotient(a: Expr, b: Expr) -> Expr {
    binary(a, BinOp::Div(Token![/](Span::call_site())), b)
}

/// `receiver.method(argument)`
pub fn method(receiver: Expr, method: &str, argument: Expr) -> Expr {
    let receiver = if precedence(&receiver) < Precedence::Postfix { parenthesised(receiver) } else { receiver };
    Expr::MethodCall(syn::ExprMethodCall {
        attrs: vec![],
        receiver: Box::new(receiver),
        dot_token: Token![.](Span::call_site()),
        method: Ident::new(method, Span::call_site()),
        turbofish: None,
        paren_token: syn::token::Paren::default(),
        args: std::iter::once(argument).collect(),
    })
}

/// `function(arguments)`
pub fn call(function: &str, arguments: impl IntoIterator<Item = Expr>) -> Expr {
    let args: Punctuated<Expr, Token![,]> = arguments.into_iter().collect();
    Expr::Call(ExprCall {
        attrs: vec![],
        func: Box::new(variable(function)),
        paren_token: syn::token::Paren::default(),
        args,
    })
}

/// `array[i]`
pub fn element(array: Expr, index: usize) -> Expr {
    Expr::Index(syn::ExprIndex {
        attrs: vec![],
        expr: Box::new(array),
        bracket_token: syn::token::Bracket::default(),
        index: Box::new(integer(index)),
    })
}

/// `value.field`
pub fn field(value: Expr, name: &str) -> Expr {
    Expr::Field(syn::ExprField {
        attrs: vec![],
        base: Box::new(value),
        dot_token: Token![.](Span::call_site()),
        member: syn::parse_str(name).expect("a name or the place in a tuple"),
    })
}

/// `&mut value`
pub fn borrow_mut(value: Expr) -> Expr {
    Expr::Reference(ExprReference {
        attrs: vec![],
        and_token: Token![&](Span::call_site()),
        mutability: Some(Token![mut](Span::call_site())),
        expr: Box::new(value),
    })
}

#[derive(PartialEq, PartialOrd)]
enum Precedence {
    Sum,
    Product,
    Unary,
    Postfix,
}

fn precedence(expr: &Expr) -> Precedence {
    match expr {
        Expr::Binary(ExprBinary { op: BinOp::Add(_) | BinOp::Sub(_), .. }) => Precedence::Sum,
        Expr::Binary(_) => Precedence::Product,
        Expr::Unary(_) | Expr::Reference(_) => Precedence::Unary,
        _ => Precedence::Postfix,
    }
}

fn parenthesised(expr: Expr) -> Expr {
    Expr::Paren(ExprParen { attrs: vec![], paren_token: syn::token::Paren::default(), expr: Box::new(expr) })
}

/// Parentheses wherever the order of operations would otherwise change: floating-point sums are not associative.
fn binary(a: Expr, op: BinOp, b: Expr) -> Expr {
    let precedence_here = match op {
        BinOp::Add(_) | BinOp::Sub(_) => Precedence::Sum,
        _ => Precedence::Product,
    };
    let left = if precedence(&a) < precedence_here { parenthesised(a) } else { a };
    let right = if precedence(&b) <= precedence_here { parenthesised(b) } else { b };
    Expr::Binary(ExprBinary { attrs: vec![], left: Box::new(left), op, right: Box::new(right) })
}

/// `array[index]`
#[expect(clippy::needless_pass_by_value, reason = "as `element`, which a constant index goes to")]
pub fn place(array: Expr, index: &Expr) -> Expr {
    parse_quote!(#array[#index])
}

/// `8 + 3 * k`
pub fn at(Progression { first, step }: Progression) -> Expr {
    let k = Ident::new("k", Span::call_site());
    let offset: Expr = match integer(step.unsigned_abs()) {
        _ if step.unsigned_abs() == 1 => parse_quote!(#k),
        stride => parse_quote!(#stride * #k),
    };
    let start = integer(first);
    match (first, step) {
        (0, 0..) => offset,
        (_, 0..) => parse_quote!(#start + #offset),
        _ => parse_quote!(#start - #offset),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use quote::ToTokens;

    fn text(expr: &Expr) -> String {
        expr.to_token_stream().to_string().replace(' ', "")
    }

    #[test]
    fn order_of_operations_is_kept() {
        let (a, b, c) = (|| variable("a"), || variable("b"), || variable("c"));
        assert_eq!(text(&product(sum(a(), b()), c())), "(a+b)*c");
        assert_eq!(text(&sum(a(), sum(b(), c()))), "a+(b+c)");
        assert_eq!(text(&sum(sum(a(), b()), c())), "a+b+c");
        assert_eq!(text(&sum(a(), literal(-2.0))), "a-2.0");
        assert_eq!(text(&difference(a(), difference(b(), c()))), "a-(b-c)");
        assert_eq!(text(&negative(sum(a(), b()))), "-(a+b)");
        assert_eq!(text(&negative(product(a(), b()))), "-(a*b)");
        assert_eq!(text(&negative(literal(-2.0))), "2.0");
        assert_eq!(text(&negative(product(literal(2.0), b()))), "-2.0*b");
        assert_eq!(text(&quotient(a(), product(b(), c()))), "a/(b*c)");
        assert_eq!(text(&product(negative(a()), b())), "-a*b");
        assert_eq!(text(&method(sum(a(), b()), "min", c())), "(a+b).min(c)");
    }

    #[test]
    fn numbers_read_back_as_themselves() {
        for value in [0.1, 1e300, 5e-324, 9.81, 1.0 / 3.0, 2.0] {
            let printed = text(&literal(value));
            assert!(printed.len() < 26, "{printed}");
            assert_eq!(printed.parse::<f64>().unwrap().to_bits(), value.to_bits());
        }
        assert_eq!(text(&literal(-2.5)), "-2.5");
    }
}
