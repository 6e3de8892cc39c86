//! Curves in laws: lines from point to point.

use proc_macro2::Span;
use syn::Expr;
use syn::spanned::Spanned;

use super::expressions::{Evaluator, Names, Result, Value, fail, mismatch};
use super::model::{Assumption, Condition};
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::symbolic::{Expression, Function};
use crate::syntax::dump;

/// A stretch of equal slope, by the numbers of its first and its last point.
struct Piece {
    first: usize,
    last: usize,
    slope: Expression,
}

impl<N: Names> Evaluator<'_, N> {
    /// `interpolate(x, places, values)`; the outer lines go on.
    pub(super) fn curve(&mut self, x: &Expr, places: &Expr, values: &Expr) -> Result<Value> {
        let argument = self
            .scalar(x)
            .map_err(|report| in_order(report, [x, places, values]))?;
        let (xs, ys) = (self.points(places)?, self.points(values)?);
        if xs.len() != ys.len() {
            let (wanted, found) = (xs.len(), ys.len());
            let message = format!("expected {wanted} values, one for each place, found {found}");
            return mismatch(values.span(), message);
        }
        if xs.len() < 2 {
            let message = "expected at least two points, found one".to_owned();
            return mismatch(places.span(), message);
        }
        Ok(Value::Scalar(if self.names.reads_units() {
            self.like_a_curve(argument, &xs, &ys)
        } else {
            let pieces = self.pieces((places, &xs), (values, &ys))?;
            self.along(argument, &pieces, &xs, &ys)
        }))
    }

    fn points(&mut self, list: &Expr) -> Result<Vec<Expression>> {
        match self.evaluate(list)? {
            Value::Matrix(column) if column.columns() == 1 => {
                Ok(column.to_matrix(self.pool).entries)
            }
            other => {
                let found = other.shape();
                let message = format!("expected a vector such as `[0.0, 1.0]`, found {found}");
                mismatch(list.span(), message)
            }
        }
    }

    /// The lines, those of equal slope in a row as one.
    fn pieces(
        &mut self,
        (places, xs): (&Expr, &[Expression]),
        (values, ys): (&Expr, &[Expression]),
    ) -> Result<Vec<Piece>> {
        let mut pieces: Vec<Piece> = Vec::new();
        for (first, (x, y)) in xs.windows(2).zip(ys.windows(2)).enumerate() {
            let last = first + 1;
            let way = self.pool.subtract(x[1], x[0]);
            self.check_rise(way, [x[0], x[1]], entry(places, last))?;
            let rise = self.pool.subtract(y[1], y[0]);
            let slope = self.pool.divide(rise, way).unwrap_or(Expression::ZERO);
            let is_sound = |it| self.pool.constant_value(it).is_none_or(f64::is_finite);
            if ![way, slope].into_iter().all(is_sound) {
                let message = "the slope of the line to this value is not a finite number";
                let report = error(codes::NOT_FINITE, entry(values, last), message);
                return Err(Box::new(report));
            }
            match pieces.last_mut() {
                Some(before) if before.slope == slope => before.last = last,
                _ => pieces.push(Piece { first, last, slope }),
            }
        }
        Ok(pieces)
    }

    /// Places rise; of parameters that is checked when a model is made.
    fn check_rise(&mut self, way: Expression, ends: [Expression; 2], place: Span) -> Result<()> {
        if let Some(way) = self.pool.constant_value(way) {
            if way > 0.0 {
                return Ok(());
            }
            return match ends.map(|end| self.pool.constant_value(end)) {
                [Some(before), Some(found)] => {
                    let message = format!("expected a place beyond {before}, found {found}");
                    let report = error(codes::EXPRESSION, place, message);
                    let help =
                        "places rise: where they fall, write both vectors from their other ends";
                    Err(Box::new(report.help(help)))
                }
                _ => fail(place, "expected a place beyond the one before"),
            };
        }
        let assumption = Assumption {
            expression: way,
            condition: Condition::Positive,
            reason: "the places of a curve rise by it".to_owned(),
        };
        if self.names.assume(self.pool, assumption) {
            return Ok(());
        }
        fail(place, "expected places of numbers and parameters alone")
    }

    /// What each piece adds, counted from the point with the smallest value that is known: along a curve that rises or falls
    /// all terms have one sign then, and the digits of small values are kept.
    ///
    /// At a point the slope is that of the piece before it, by the order of what is compared.
    fn along(
        &mut self,
        argument: Expression,
        pieces: &[Piece],
        xs: &[Expression],
        ys: &[Expression],
    ) -> Expression {
        let size = |point: &usize| match self.pool.constant_value(ys[*point]) {
            Some(value) => value.abs(),
            None => f64::INFINITY,
        };
        let points = 0..ys.len();
        let start = points.min_by(|a, b| size(a).total_cmp(&size(b)));
        let start = start.unwrap_or_default();
        let mut sum = ys[start];
        for piece in pieces {
            let mut inside = argument;
            if piece.first > 0 {
                let bounds = [inside, xs[piece.first]];
                inside = self.pool.call(Function::Max, &bounds);
            }
            if piece.last + 1 < xs.len() {
                let bounds = [xs[piece.last], inside];
                inside = self.pool.call(Function::Min, &bounds);
            }
            let nearest = xs[start.clamp(piece.first, piece.last)];
            let way = self.pool.subtract(inside, nearest);
            let rise = self.pool.multiply(piece.slope, way);
            sum = self.pool.add(sum, rise);
        }
        sum
    }

    /// What has the units of a curve: the argument and the places share one, and so do the values. A slope of whole
    /// numbers would count instead.
    fn like_a_curve(
        &mut self,
        argument: Expression,
        xs: &[Expression],
        ys: &[Expression],
    ) -> Expression {
        let mut largest = |start, list: &[Expression]| {
            list.iter().fold(start, |found, it| {
                // Each beside the first, which a message shows then.
                let larger = self.pool.call(Function::Max, &[start, *it]);
                self.pool.call(Function::Max, &[found, larger])
            })
        };
        let (place, value) = (largest(argument, xs), largest(ys[0], &ys[1..]));
        let choice = [argument, place, value, ys[0]];
        self.pool.call(Function::SelectLess, &choice)
    }
}

/// What to type where the vectors come before what they are read at.
fn in_order(report: Box<Diagnostic>, arguments: [&Expr; 3]) -> Box<Diagnostic> {
    let [x, places, values] = arguments.map(dump::expression);
    match arguments.map(|it| matches!(it, Expr::Array(_))) {
        [true, true, false] => {
            Box::new(report.help(format!("write `interpolate({values}, {x}, {places})`")))
        }
        _ => report,
    }
}

/// Where an entry of a vector stands: in the vector as it is written, or under its name.
fn entry(list: &Expr, index: usize) -> Span {
    match list {
        Expr::Array(array) => array.elems.get(index).map_or(list.span(), Spanned::span),
        _ => list.span(),
    }
}
