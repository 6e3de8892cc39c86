//! Components of vectors, rows of matrices and parts of either in laws.

use proc_macro2::{Ident, Span};
use syn::spanned::Spanned;
use syn::{Expr, RangeLimits};

use super::expressions::{Evaluator, Names, Result, Value, component_index, fail, mismatch};
use crate::symbolic::Product;

impl<N: Names> Evaluator<'_, N> {
    /// The component `x`, `y` or `z`.
    pub(super) fn component(&mut self, value: Value, name: &Ident) -> Result<Value> {
        let Some(index) = component_index(name) else {
            return fail(
                name.span(),
                format!("expected `x`, `y` or `z`, found `{name}`"),
            );
        };
        self.pick(value, index as i64, name.span())
    }

    fn pick(&mut self, value: Value, index: i64, span: Span) -> Result<Value> {
        let shape = value.shape();
        let entries = value.entries(self.pool).unwrap_or_default();
        match usize::try_from(index)
            .ok()
            .and_then(|index| entries.get(index))
        {
            Some(entry) => Ok(Value::Scalar(*entry)),
            None => mismatch(span, format!("component {index} of {shape} does not exist")),
        }
    }

    /// A row of a matrix, as a vector.
    fn row(&mut self, product: &Product, index: i64, span: Span) -> Result<Value> {
        let matrix = product.to_matrix(self.pool);
        match usize::try_from(index) {
            Ok(row) if row < matrix.rows => {
                let entries = (0..matrix.columns).map(|column| matrix.at(row, column));
                Ok(Value::column(entries.collect()))
            }
            _ => {
                let shape = Value::Matrix(product.clone()).shape();
                mismatch(span, format!("row {index} of {shape} does not exist"))
            }
        }
    }

    /// What brackets take out of a value.
    pub(super) fn index(&mut self, index: &syn::ExprIndex) -> Result<Value> {
        if let Expr::Path(base) = &*index.expr
            && let Some(name) = base.path.get_ident()
        {
            self.check_whole(name)?;
        }
        let value = self.evaluate(&index.expr)?;
        let span = index.index.span();
        let Expr::Range(range) = &*index.index else {
            let number = self.names.whole(&index.index)?;
            return match value {
                Value::Matrix(product) if product.columns() > 1 => self.row(&product, number, span),
                value => self.pick(value, number, span),
            };
        };
        let (Some(start), Some(end), RangeLimits::HalfOpen(_)) =
            (&range.start, &range.end, &range.limits)
        else {
            return fail(
                span,
                "expected a range such as `1..3`, which excludes its end",
            );
        };
        let (start, end) = (self.names.whole(start)?, self.names.whole(end)?);
        let shape = value.shape();
        let entries = value.entries(self.pool).unwrap_or_default();
        match (usize::try_from(start), usize::try_from(end)) {
            (Ok(first), Ok(last)) if first < last && last <= entries.len() => {
                Ok(Value::column(entries[first..last].to_vec()))
            }
            _ => mismatch(
                span,
                format!("components {start}..{end} of {shape} do not exist"),
            ),
        }
    }
}
