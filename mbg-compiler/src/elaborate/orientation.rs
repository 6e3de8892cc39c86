//! Functions of orientations in laws: rotations, and their conversions into each other.

use proc_macro2::{Ident, Span};
use syn::Expr;
use syn::spanned::Spanned;

use super::expressions::{Evaluator, Names, Result, Value, fail, mismatch};
use crate::codes;
use crate::diagnostics::error;
use crate::symbolic::orientation::{angles_of, matrix_of, quaternion_of};
use crate::symbolic::{Expression, Factor, Matrix, Pool, Product, Rate, rounded};

/// How each function is called.
const USAGES: [&str; 11] = [
    "rot_x(angle)",
    "rot_y(angle)",
    "rot_z(angle)",
    "rot(axis, angle)",
    "jacobian_xyz(angles)",
    "jacobian(angles, 0, 1, 2)",
    "matrix_of(quaternion)",
    "matrix_of(angles, 0, 1, 2)",
    "quaternion_of(matrix)",
    "angles_of(matrix, 0, 1, 2)",
    "rotation(matrix)",
];

/// Rounding in a rotation that is written as numbers.
const ROUNDING: f64 = 1e-6;

impl<N: Names> Evaluator<'_, N> {
    /// The value of a function of this file; none if it is another one.
    pub(super) fn orientation(
        &mut self,
        name: &Ident,
        arguments: &[Expr],
    ) -> Option<Result<Value>> {
        let value = match (name.to_string().as_str(), arguments) {
            ("rot_x", [angle]) => self.turn(0, angle),
            ("rot_y", [angle]) => self.turn(1, angle),
            ("rot_z", [angle]) => self.turn(2, angle),
            ("rot", [axis, angle]) => self.axis(axis).and_then(|axis| self.turn(axis, angle)),
            ("jacobian_xyz", [angles]) => self.jacobian(angles, [0, 1, 2]),
            ("jacobian", [angles, axes @ ..]) if axes.len() == 3 => self
                .sequence(axes)
                .and_then(|axes| self.jacobian(angles, axes)),
            ("matrix_of", [quaternion]) => self.matrix_of(quaternion),
            ("matrix_of", [angles, axes @ ..]) if axes.len() == 2 => self.turns::<2>(angles, axes),
            ("matrix_of", [angles, axes @ ..]) if axes.len() == 3 => self.turns::<3>(angles, axes),
            ("quaternion_of", [matrix]) => self
                .rotation(matrix)
                .map(|matrix| Value::column(quaternion_of(self.pool, &matrix).to_vec())),
            ("angles_of", [matrix, axes @ ..]) if axes.len() == 3 => self.angles_of(matrix, axes),
            ("rotation", [matrix]) => self
                .evaluate(matrix)
                .and_then(|value| checked(self.pool, value, matrix.span()))
                .map(Value::Matrix),
            (known, _) => {
                let usages = USAGES
                    .iter()
                    .filter(|it| it.starts_with(&format!("{known}(")));
                let usages: Vec<String> = usages.map(|it| format!("`{it}`")).collect();
                if usages.is_empty() {
                    return None;
                }
                fail(name.span(), format!("expected {}", usages.join(" or ")))
            }
        };
        Some(value)
    }

    fn turn(&mut self, axis: usize, angle: &Expr) -> Result<Value> {
        let angle = self.scalar(angle)?;
        Ok(Value::Matrix(Product::of(Factor::Rotation { axis, angle })))
    }

    fn jacobian(&mut self, angles: &Expr, axes: [usize; 3]) -> Result<Value> {
        let factor = Factor::GimbalJacobian {
            axes,
            angles: self.column(angles)?,
            transposed: false,
        };
        Ok(Value::Matrix(Product::of(factor)))
    }

    fn matrix_of(&mut self, quaternion: &Expr) -> Result<Value> {
        let quaternion = self.column(quaternion)?;
        let matrix = matrix_of(self.pool, quaternion);
        Ok(Value::Matrix(Product::of(Factor::Dense(matrix))))
    }

    /// Turns in a row, the first outermost.
    fn turns<const D: usize>(&mut self, angles: &Expr, axes: &[Expr]) -> Result<Value> {
        let axes = self.sequence::<D>(axes)?;
        let angles = self.column::<D>(angles)?;
        let turns = axes.into_iter().zip(angles);
        let factors = turns.map(|(axis, angle)| Factor::Rotation { axis, angle });
        Ok(Value::Matrix(Product {
            factors: factors.collect(),
        }))
    }

    fn angles_of(&mut self, matrix: &Expr, axes: &[Expr]) -> Result<Value> {
        let (axes, matrix) = (self.sequence(axes)?, self.rotation(matrix)?);
        Ok(Value::column(angles_of(self.pool, &matrix, axes).to_vec()))
    }

    /// A rotation, or the number 1 for none.
    fn rotation(&mut self, matrix: &Expr) -> Result<Matrix> {
        let value = self.evaluate(matrix)?;
        rotation(self.pool, value, matrix.span())
    }

    /// A vector of known dimension.
    pub(super) fn column<const D: usize>(&mut self, argument: &Expr) -> Result<[Expression; D]> {
        let value = self.evaluate(argument)?;
        let shape = value.shape();
        let entries = value.entries(self.pool).unwrap_or_default();
        entries.try_into().or_else(|_| {
            let message = format!("expected a vector of {D}, found {shape}");
            mismatch(argument.span(), message)
        })
    }

    /// Axes of turns in a row, no neighbours equal.
    fn sequence<const D: usize>(&mut self, axes: &[Expr]) -> Result<[usize; D]> {
        let mut sequence = [0; D];
        for (axis, place) in axes.iter().zip(&mut sequence) {
            *place = self.axis(axis)?;
        }
        let Some(at) = sequence.windows(2).position(|pair| pair[0] == pair[1]) else {
            return Ok(sequence);
        };
        let (axis, first, second) = (sequence[at], &axes[at], &axes[at + 1]);
        let message = format!(
            "the axes of two turns in a row are parallel, {axis} and {axis}, which makes them one turn"
        );
        let span = first.span();
        let span = span.join(second.span()).unwrap_or(span);
        let examples = if D == 2 {
            "two axes such as `0, 1` or `2, 0`"
        } else {
            "three axes such as `0, 1, 2` or `2, 0, 2`"
        };
        let report = error(codes::EXPRESSION, span, message).help(format!("write {examples}"));
        Err(Box::new(report.about(second).about(first)))
    }

    fn axis(&mut self, axis: &Expr) -> Result<usize> {
        match usize::try_from(self.names.whole(axis)?) {
            Ok(number) if number < 3 => Ok(number),
            _ => fail(axis.span(), "expected 0, 1 or 2 for the axis x, y or z"),
        }
    }
}

/// The entries of a 3×3 matrix, or of the number 1 for the unit matrix. What is constant must be that of a rotation.
pub(super) fn rotation(pool: &mut Pool, value: Value, span: Span) -> Result<Matrix> {
    Ok(checked(pool, value, span)?.to_matrix(pool))
}

/// A rotation as it is written, but for the rounding of numbers. Numbers that make three turns make one matrix, which costs
/// less.
fn checked(pool: &mut Pool, value: Value, span: Span) -> Result<Product> {
    match value {
        Value::Scalar(Expression::ONE) => {
            let unit = Matrix::diagonal(&[Expression::ONE; 3]);
            Ok(Product::of(Factor::Dense(unit)))
        }
        Value::Matrix(product) if (product.rows(), product.columns()) == (3, 3) => {
            let is_turn = |factor: &Factor| matches!(factor, Factor::Rotation { .. });
            let matrix = product.to_matrix(pool);
            if product.factors.iter().all(is_turn) {
                let mut entries = matrix.entries.iter();
                let is_one = product.factors.len() > 2
                    && entries.all(|entry| pool.rate(*entry) == Rate::Constant);
                return Ok(match is_one {
                    true => Product::of(Factor::Dense(matrix)),
                    false => product,
                });
            }
            let errors = errors(pool, &matrix);
            let is_rounding = |error: &Expression| {
                let constant = pool.constant_value(*error);
                constant.is_none_or(|error| error.abs() <= ROUNDING)
            };
            if errors.iter().all(is_rounding) {
                let is_exact = errors.iter().all(|error| *error == Expression::ZERO);
                let numbers = numbers(pool, &matrix).filter(|_| !is_exact);
                return Ok(numbers.map_or(product, |numbers| rounded::rotation(pool, numbers)));
            }
            let message =
                "this matrix is no rotation: its columns must be orthonormal and right-handed";
            let report = error(codes::NO_ROTATION, span, message);
            Err(Box::new(report.help(
                "write a product of rotations, such as `rot_z(0.5) * rot_x(0.1)`",
            )))
        }
        found => mismatch(
            span,
            format!("expected a 3×3 matrix, found {}", found.shape()),
        ),
    }
}

/// By how much the products of a matrix differ from those of a rotation.
fn errors(pool: &mut Pool, matrix: &Matrix) -> Vec<Expression> {
    let gram = matrix.transpose().times(pool, matrix);
    let determinant = matrix.determinant(pool);
    let wanted = Matrix::diagonal(&[Expression::ONE; 3]);
    let pairs = gram
        .entries
        .iter()
        .zip(&wanted.entries)
        .chain([(&determinant, &Expression::ONE)]);
    pairs
        .map(|(found, wanted)| pool.subtract(*found, *wanted))
        .collect()
}

/// The entries by rows, if they are numbers.
fn numbers(pool: &Pool, matrix: &Matrix) -> Option<[[f64; 3]; 3]> {
    let row = |row: usize| {
        let entry = |column: usize| pool.constant_value(matrix.at(row, column));
        Some([entry(0)?, entry(1)?, entry(2)?])
    };
    Some([row(0)?, row(1)?, row(2)?])
}
